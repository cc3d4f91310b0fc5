//! Text and numbers for HTML and SVG: a value enters; its escaped or rounded text leaves.

/// `text`, escaped for element content and for quoted attributes, in HTML and in XML. Control characters become U+FFFD,
/// because XML cannot carry them even if escaped.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            '\n' | '\t' => escaped.push(character),
            '\u{FFFE}' | '\u{FFFF}' => escaped.push('\u{FFFD}'),
            _ if character.is_control() => escaped.push('\u{FFFD}'),
            _ => escaped.push(character),
        }
    }
    escaped
}

/// `value` to `digits` significant digits, without an exponent from 1e-6 up to 1e9, with a true minus sign.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return if value.is_nan() { "not a number".into() } else { "unbounded".into() };
    }
    if value == 0.0 {
        return "0".into();
    }
    // Rounding comes first: 0.09996 to three digits is 0.100, one decade higher.
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let spelled = if (-6..9).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        scientific
    };
    spelled.replace('-', "\u{2212}")
}

/// A length in metres that is below this is shown in millimetres.
pub const MILLIMETRES_BELOW_M: f64 = 0.1;

/// `value` with its unit, to three significant digits. Short lengths are in millimetres.
pub fn quantity(value: f64, unit: &str) -> String {
    if unit == "m" && value != 0.0 && value.abs() < MILLIMETRES_BELOW_M {
        return quantity(value * 1e3, "mm");
    }
    format!("{}\u{a0}{unit}", significant(value, 3))
}

/// A count with its thousands separated: `31,097`.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut parted = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            parted.push(',');
        }
        parted.push(digit);
    }
    parted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_cannot_leave_its_text() {
        assert_eq!(escape("<b a=\"1\" c='2'>&"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;");
        assert_eq!(escape("a\u{0}\u{1b}b\u{FFFF}\n"), "a\u{FFFD}\u{FFFD}b\u{FFFD}\n");
        assert_eq!(escape("2nd Straße, δt"), "2nd Straße, δt");
    }

    #[test]
    fn digits_that_count_are_kept() {
        let cases = [
            (0.0, "0"),
            (0.021_34, "0.0213"),
            (0.099_96, "0.100"),
            (-4.25, "−4.25"),
            (999.6, "1000"),
            (12_345.0, "12345"),
            (1e-7, "1.00e−7"),
            (f64::NAN, "not a number"),
        ];
        for (value, expected) in cases {
            assert_eq!(significant(value, 3), expected);
        }
    }

    #[test]
    fn thousands_are_parted() {
        for (value, expected) in [(0, "0"), (999, "999"), (1000, "1,000"), (31_097, "31,097"), (1_000_000, "1,000,000")]
        {
            assert_eq!(count(value), expected);
        }
    }
}
