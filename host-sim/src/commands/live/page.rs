//! The files of the page, and the WebGL library that it uses, bundled in the program.

/// A file: its path, its type and its content.
pub type File = (&'static str, &'static str, &'static str);

macro_rules! files {
    ($($path:literal $kind:literal $name:literal)+; ogl: $($module:literal)+) => {
        &[
            $(($path, $kind, include_str!(concat!("page/", $name)))),+,
            $((
                concat!("/ogl/", $module),
                "text/javascript; charset=utf-8",
                include_str!(concat!("../../../third-party/ogl/src/", $module)),
            )),+
        ]
    };
}

/// Every file.
pub const FILES: &[File] = files![
    "/" "text/html; charset=utf-8" "index.html"
    "/style.css" "text/css; charset=utf-8" "style.css"
    "/main.js" "text/javascript; charset=utf-8" "main.js"
    "/link.js" "text/javascript; charset=utf-8" "link.js"
    "/scene.js" "text/javascript; charset=utf-8" "scene.js"
    "/plots.js" "text/javascript; charset=utf-8" "plots.js"
    "/drive.js" "text/javascript; charset=utf-8" "drive.js"
    "/pad.js" "text/javascript; charset=utf-8" "pad.js"
    "/touch.js" "text/javascript; charset=utf-8" "touch.js"
    "/frames.js" "text/javascript; charset=utf-8" "frames.js"
    "/tour.js" "text/javascript; charset=utf-8" "tour.js"
    "/map.js" "text/javascript; charset=utf-8" "map.js"
    "/roads.js" "text/javascript; charset=utf-8" "roads.js"
    "/stage.js" "text/javascript; charset=utf-8" "stage.js"
    "/view.js" "text/javascript; charset=utf-8" "view.js";
    ogl:
    "core/Camera.js"
    "core/Geometry.js"
    "core/Mesh.js"
    "core/Program.js"
    "core/Renderer.js"
    "core/Transform.js"
    "extras/Box.js"
    "extras/Plane.js"
    "math/Euler.js"
    "math/Mat3.js"
    "math/Mat4.js"
    "math/Quat.js"
    "math/Vec3.js"
    "math/functions/EulerFunc.js"
    "math/functions/Mat3Func.js"
    "math/functions/Mat4Func.js"
    "math/functions/QuatFunc.js"
    "math/functions/Vec3Func.js"
    "math/functions/Vec4Func.js"
];

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn all_that_a_module_imports_is_bundled() {
        let mut found = 0;
        for (path, _, text) in FILES {
            let imports = text.lines().filter_map(|line| line.strip_prefix("import ")?.split(['"', '\'']).nth(1));
            for import in imports {
                let folder = Path::new(path).parent().unwrap();
                let target = import.split('/').fold(folder.to_path_buf(), |at, part| match part {
                    "." => at,
                    ".." => at.parent().unwrap().to_path_buf(),
                    part => at.join(part),
                });
                assert!(FILES.iter().any(|(other, ..)| Path::new(other) == target), "{path} imports {import}");
                found += 1;
            }
        }
        assert!(found > FILES.len(), "{found} imports");
    }
}
