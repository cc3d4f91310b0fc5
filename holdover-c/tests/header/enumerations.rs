//! The enumerations: as the generator writes them they enter, as integers with constants of their type they leave.
//!
//! An enumerated type that is stored in an integer is two types to MISRA C (rules 10.1 to 10.5), and so is each comparison with
//! one of its constants. An integer type whose constants have that type is one.

/// The header with each `enum X : T { A = n, ... }` as a `typedef T X` and `#define A ((X)n)`.
pub fn as_constants(header: &str) -> String {
    let mut text = String::new();
    let mut lines = header.lines();
    while let Some(line) = lines.next() {
        let Some(name) = line.strip_prefix("enum ") else {
            text += line;
            if line.starts_with("#define ")
                && line.ends_with(|end: char| end.is_ascii_digit())
                && line.matches(' ').count() == 2
            {
                text.push('U'); // all other constants are magnitudes
            }
            text.push('\n');
            continue;
        };
        let kind = lines.by_ref().find_map(|line| line.strip_prefix("  : ")).expect("the type that it is stored in");
        text += &format!("typedef {kind} {name};\n");
        for line in lines.by_ref().skip_while(|line| *line != " {").skip(1).take_while(|line| *line != "};") {
            text += &match line.trim().trim_end_matches(',').split_once(" = ") {
                Some((constant, value)) if !line.trim().starts_with("//") => {
                    let unsigned = if kind.starts_with('u') { "U" } else { "" };
                    format!("#define {constant} (({name}){value}{unsigned})\n")
                }
                _ => format!("{}\n", line.trim()),
            };
        }
        // What made a type of it.
        let mut depth = 0;
        for line in lines.by_ref() {
            depth += i32::from(line.starts_with("#if")) - i32::from(line.starts_with("#endif"));
            if depth == 0 {
                break;
            }
        }
    }
    text
}
