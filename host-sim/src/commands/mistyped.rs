//! A command line that cannot be understood: the parser's error enters; one line that names cause and remedy leaves.

use clap::Error as Refusal;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::error::{Error, quoted};

/// The line, or nothing where the user asked for help or for the version.
#[must_use]
pub fn line(refusal: &Refusal) -> Option<Error> {
    let said = |kind: ContextKind| refusal.get(kind).map(words).filter(|words| !words.is_empty());
    let argument = said(ContextKind::InvalidArg).unwrap_or_default();
    let see = || format!("see `{} --help`", command(refusal));
    let meant = |kind: ContextKind| said(kind).map(|meant| format!("did you mean '{meant}'?"));
    Some(match refusal.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            return None;
        }
        ErrorKind::UnknownArgument => {
            let remedy = meant(ContextKind::SuggestedArg).unwrap_or_else(see);
            Error::new(format!("there is no argument {}", quoted_bare(&argument)), remedy)
        }
        ErrorKind::InvalidSubcommand => {
            let word = said(ContextKind::InvalidSubcommand).unwrap_or_default();
            let remedy = meant(ContextKind::SuggestedSubcommand).unwrap_or_else(see);
            Error::new(format!("there is no command {}", quoted_bare(&word)), remedy)
        }
        ErrorKind::ValueValidation | ErrorKind::InvalidValue => invalid(refusal, option(&argument)),
        ErrorKind::MissingRequiredArgument => {
            Error::new(format!("{argument} is missing"), format!("give it, or {}", see()))
        }
        ErrorKind::ArgumentConflict => {
            let other = said(ContextKind::PriorArg).unwrap_or_default();
            Error::new(format!("{argument} cannot be used together with {other}"), "leave one of them out")
        }
        _ => {
            let text = refusal.to_string();
            let first = text.lines().next().unwrap_or_default();
            Error::new(first.strip_prefix("error: ").unwrap_or(first), see())
        }
    })
}

/// A value that is none for its argument.
fn invalid(refusal: &Refusal, option: &str) -> Error {
    let of = |kind: ContextKind| refusal.get(kind).map(words);
    let value = of(ContextKind::InvalidValue).unwrap_or_default();
    if value.is_empty() {
        return Error::new("has no value", "give one").in_option(option);
    }
    let remedy = match of(ContextKind::ValidValue) {
        Some(values) => format!("give one of {values}"),
        None => wanted(refusal),
    };
    Error::new(format!("is {}", quoted(&value)), remedy).in_option(option)
}

/// What a number has to be. The parser of the standard library says why one is none.
fn wanted(refusal: &Refusal) -> String {
    let text = refusal.to_string();
    let why = text.lines().next().and_then(|line| line.rsplit_once(": ")).map_or("", |(_, why)| why);
    match why {
        "invalid digit found in string" | "number too large to fit in target type" => {
            "give a whole number from 0 on".into()
        }
        "invalid float literal" => "give a number".into(),
        remedy if remedy.starts_with("give ") => remedy.into(),
        why => format!("give another value ({why})"),
    }
}

/// The option of an argument, as in `--seed` of `--seed <N>`.
fn option(argument: &str) -> &str {
    argument.split([' ', '=', '[']).next().unwrap_or(argument)
}

/// The command in which it was mistyped.
fn command(refusal: &Refusal) -> String {
    let usage = refusal.get(ContextKind::Usage).map(words).unwrap_or_default();
    let usage = usage.split_once("holdover-sim ").map_or("", |(_, rest)| rest);
    let command =
        usage.split_whitespace().next().filter(|word| word.chars().all(|c| c.is_ascii_lowercase() || c == '-'));
    match command {
        Some(command) if !command.starts_with('-') => format!("holdover-sim {command}"),
        _ => "holdover-sim".to_owned(),
    }
}

fn quoted_bare(word: &str) -> String {
    quoted(word.trim_matches('\''))
}

fn words(value: &ContextValue) -> String {
    let text = match value {
        ContextValue::String(word) => word.clone(),
        ContextValue::Strings(words) => words.join(", "),
        ContextValue::StyledStr(text) => text.to_string(),
        ContextValue::StyledStrs(texts) => texts.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
        ContextValue::Bool(_) | ContextValue::Number(_) | ContextValue::None => String::new(),
        _ => String::new(),
    };
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}
