//! `holdover.h` says what the sources say.

mod enumerations;
mod layout;

use std::path::Path;

/// What the program may have for the library.
const HOOK: &str = "
// Not of the library: a program on a bare machine may have it. A panic of the library calls it, and when it returns the processor stays
// where it is. Whoever links as docs/INTEGRATION.md says can see that nothing reaches a panic.
void holdover_panicked(void);
";

fn header() -> String {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(package.join("cbindgen.toml")).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(config);
    for name in ["answer", "config", "config/identifiers", "doors", "frame", "incident", "map", "memory", "status"] {
        builder = builder.with_src(package.join("src").join(name).with_extension("rs"));
    }
    let mut text = Vec::new();
    builder.generate().unwrap().write(&mut text);
    let text = String::from_utf8(text).unwrap();
    // The generator names values after their type; the type's `_t` has no place there, nor has Rust's markup.
    let text =
        text.replace("HOLDOVER_STATUS_T_", "HOLDOVER_").replace("_T_", "_").replace("[`", "`").replace("`]", "`");
    let text = enumerations::as_constants(&text);
    let (text, end) = text.split_once("#ifdef __cplusplus\nextern").expect("the functions");
    let (functions, end) = end.split_once("\n#ifdef __cplusplus\n}").expect("the end");
    format!("{text}{}\n#ifdef __cplusplus\nextern{functions}{HOOK}\n#ifdef __cplusplus\n}}{end}", layout::assertions())
}

/// Every field of every struct is in it, so that none goes unasserted.
#[test]
fn the_layouts_have_every_field_of_every_struct() {
    let (header, layouts) = (header(), layout::layouts());
    assert_eq!(header.matches("typedef struct ").count(), layouts.len());
    for layout in layouts {
        let from = header.split_once(&format!("typedef struct {} {{\n", layout.name)).expect(layout.name).1;
        let lines = from.lines().take_while(|line| !line.starts_with('}')).filter(|line| line.ends_with(';'));
        let fields = lines.map(|line| line.trim_end_matches([';', ']']).split(['[']).next().unwrap());
        let fields: Vec<_> = fields.map(|field| field.rsplit([' ', '*']).next().unwrap()).collect();
        let listed: Vec<_> = layout.fields.iter().map(|(name, _)| *name).collect();
        assert_eq!(fields, listed, "{}", layout.name);
    }
}

#[test]
fn the_committed_header_is_the_one_that_the_sources_make() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("holdover.h");
    let made = header();
    if std::env::var_os("HOLDOVER_WRITE_HEADER").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == made,
        "holdover.h is not up to date: HOLDOVER_WRITE_HEADER=1 cargo test -p holdover-c --test header writes it"
    );
}

#[test]
fn the_header_is_ascii() {
    let line = header().lines().find(|line| !line.is_ascii()).map(str::to_owned);
    assert_eq!(line, None);
}

#[test]
fn the_header_has_every_function_of_the_library() {
    let doors = include_str!("../../src/doors.rs");
    let names: Vec<_> = doors
        .lines()
        .filter_map(|line| line.split_once("extern \"C\" fn ")?.1.split_once('('))
        .map(|(name, _)| name)
        .collect();
    assert!(names.len() >= 8, "{names:?}");
    let header = header();
    for name in names {
        assert!(header.contains(&format!("{name}(")), "{name}");
    }
}

#[test]
fn the_version_is_the_package_s() {
    let part = |text: &str| text.parse::<u32>().unwrap();
    let (major, minor, patch) =
        (env!("CARGO_PKG_VERSION_MAJOR"), env!("CARGO_PKG_VERSION_MINOR"), env!("CARGO_PKG_VERSION_PATCH"));
    assert_eq!(holdover_c::holdover_version(), part(major) << 16 | part(minor) << 8 | part(patch));
}
