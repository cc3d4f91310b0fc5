//! The files of the page, bundled in the program.

/// A file: its path, its type and its content.
pub type File = (&'static str, &'static str, &'static str);

macro_rules! files {
    ($($path:literal $kind:literal $name:literal),+ $(,)?) => {
        &[$(($path, $kind, include_str!(concat!("page/", $name)))),+]
    };
}

/// Every file.
pub const FILES: &[File] = files![
    "/" "text/html; charset=utf-8" "index.html",
    "/style.css" "text/css; charset=utf-8" "style.css",
    "/main.js" "text/javascript; charset=utf-8" "main.js",
    "/link.js" "text/javascript; charset=utf-8" "link.js",
    "/scene.js" "text/javascript; charset=utf-8" "scene.js",
    "/plots.js" "text/javascript; charset=utf-8" "plots.js",
    "/drive.js" "text/javascript; charset=utf-8" "drive.js",
    "/pad.js" "text/javascript; charset=utf-8" "pad.js",
    "/touch.js" "text/javascript; charset=utf-8" "touch.js",
    "/frames.js" "text/javascript; charset=utf-8" "frames.js",
    "/tour.js" "text/javascript; charset=utf-8" "tour.js",
    "/map.js" "text/javascript; charset=utf-8" "map.js",
    "/roads.js" "text/javascript; charset=utf-8" "roads.js",
    "/view.js" "text/javascript; charset=utf-8" "view.js",
];
