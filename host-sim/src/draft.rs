//! A file that is written whole or not at all: bytes enter, and the file is there when they are complete.
//!
//! The bytes go to a draft in the same folder, which takes the file's name at the end. A full disk or a kill leaves the file that was there
//! before. Until then the draft has no name, where the system has such files, so that a kill leaves nothing else either. What is no regular
//! file, such as a pipe or `/dev/stdout`, has nothing to keep, and is written straight.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::error::Error;

/// The beginning of the name of every draft.
const PREFIX: &str = ".holdover-sim-";

/// A file that is being written.
#[derive(Debug)]
pub struct Draft {
    file: PathBuf,
    out: BufWriter<Out>,
}

#[derive(Debug)]
enum Out {
    /// Without a name, in the folder of this path.
    Nameless(File, PathBuf),
    /// Beside the file of this path.
    Beside(NamedTempFile, PathBuf),
    /// Into the file itself.
    Straight(File),
}

impl Draft {
    /// A draft of the file.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn of(file: &Path) -> Result<Self, Error> {
        let out = Out::of(file).map_err(|error| Error::unwritable(file, &error))?;
        Ok(Self { file: file.to_owned(), out: BufWriter::new(out) })
    }

    /// Gives the draft its name. Without this the draft is dropped, and the old file stays.
    ///
    /// # Errors
    /// A rest that cannot be written, such as on a full disk.
    pub fn finish(self) -> Result<(), Error> {
        let Self { file, out } = self;
        let out = out.into_inner().map_err(io::IntoInnerError::into_error);
        out.and_then(Out::finish).map_err(|error| Error::unwritable(&file, &error))
    }

    /// Writes a whole file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn whole(file: &Path, content: &str) -> Result<(), Error> {
        let mut draft = Self::of(file)?;
        draft.write_all(content.as_bytes()).map_err(|error| Error::unwritable(file, &error))?;
        draft.finish()
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Out {
    fn of(file: &Path) -> io::Result<Self> {
        if is_straight(file) {
            return OpenOptions::new().write(true).open(file).map(Self::Straight);
        }
        // The file that a link leads to is written, and the link stays.
        let place = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        let rights = fs::metadata(&place).ok().map(|old| old.permissions());
        let keep = |draft: &File| rights.map_or(Ok(()), |rights| draft.set_permissions(rights));
        if let Ok(draft) = nameless::in_folder(&folder_of(&place)) {
            keep(&draft)?;
            return Ok(Self::Nameless(draft, place));
        }
        let draft = draft_in(&folder_of(&place))?;
        keep(draft.as_file())?;
        Ok(Self::Beside(draft, place))
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Straight(mut file) => file.flush(),
            Self::Nameless(draft, place) => {
                draft.sync_data()?;
                // A name can be given, but not taken from another file; a draft with a name can take it.
                let named = builder().make_in(folder_of(&place), |name| nameless::name(&draft, name))?;
                named.into_temp_path().persist(place).map_err(|error| error.error)
            }
            Self::Beside(draft, place) => {
                // Some file systems say only here that they are full.
                draft.as_file().sync_data()?;
                draft.persist(place).map(|_| ()).map_err(|error| error.error)
            }
        }
    }
}

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Beside(draft, _) => draft.write(bytes),
            Self::Nameless(file, _) | Self::Straight(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Beside(draft, _) => draft.flush(),
            Self::Nameless(file, _) | Self::Straight(file) => file.flush(),
        }
    }
}

/// Whether a file is written as it stands: a device, a pipe, or the terminal by one of its names.
#[must_use]
pub fn is_straight(file: &Path) -> bool {
    let is_there = fs::metadata(file).ok();
    file.starts_with("/dev") && is_there.is_some() || is_there.is_some_and(|there| !there.is_file() && !there.is_dir())
}

/// An empty draft in a folder, which goes when it is dropped.
///
/// # Errors
/// A folder that cannot be written.
pub fn draft_in(folder: &Path) -> io::Result<NamedTempFile> {
    #[cfg_attr(not(unix), expect(unused_mut))]
    let mut builder = builder();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Less what the user's mask takes away, as any other file.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX);
    builder
}

/// Files without a name.
#[cfg(target_os = "linux")]
mod nameless {
    use std::fs::{File, OpenOptions};
    use std::io;
    use std::os::fd::AsRawFd;
    use std::os::unix::fs::OpenOptionsExt;
    use std::path::Path;

    use nix::fcntl::{AT_FDCWD, AtFlags, OFlag};

    /// The open files of this process, by number.
    const OPEN: &str = "/proc/self/fd";

    /// A file in a folder. Not every file system has such files, and none can be named where `/proc` is not mounted.
    pub fn in_folder(folder: &Path) -> io::Result<File> {
        Path::new(OPEN).metadata()?;
        OpenOptions::new().write(true).custom_flags(OFlag::O_TMPFILE.bits()).open(folder)
    }

    /// Gives it a name that no other file has.
    pub fn name(file: &File, name: &Path) -> io::Result<()> {
        let itself = format!("{OPEN}/{}", file.as_raw_fd());
        nix::unistd::linkat(AT_FDCWD, itself.as_str(), AT_FDCWD, name, AtFlags::AT_SYMLINK_FOLLOW)
            .map_err(io::Error::from)
    }
}

#[cfg(not(target_os = "linux"))]
mod nameless {
    use std::fs::File;
    use std::io;
    use std::path::Path;

    pub fn in_folder(_: &Path) -> io::Result<File> {
        Err(io::ErrorKind::Unsupported.into())
    }

    pub fn name(_: &File, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

/// The folder of a file.
#[must_use]
pub fn folder_of(file: &Path) -> PathBuf {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draft_that_is_dropped_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        fs::write(&file, "old").unwrap();
        let mut draft = Draft::of(&file).unwrap();
        draft.write_all(&[b'x'; 100_000]).unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "old");
        drop(draft);
        assert_eq!(fs::read_to_string(&file).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_draft_that_is_finished_is_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        Draft::whole(&file, "new").unwrap();
        Draft::whole(&file, "newer").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "newer");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn where_files_without_names_can_be_a_draft_has_none() {
        let folder = tempfile::tempdir().unwrap();
        let entries = || fs::read_dir(folder.path()).unwrap().count();
        let named = usize::from(nameless::in_folder(folder.path()).is_err());
        let draft = Draft::of(&folder.path().join("a.csv")).unwrap();
        assert_eq!(entries(), named);
        draft.finish().unwrap();
        assert_eq!(entries(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_the_rights_stay_the_files() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a.csv"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        Draft::whole(&link, "new").unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_and_stays() {
        let null = Path::new("/dev/null");
        Draft::whole(null, "anything").unwrap();
        assert!(is_straight(null) && !fs::metadata(null).unwrap().is_file());
    }

    #[test]
    fn a_folder_that_is_not_there_is_said_in_plain_words() {
        let error = Draft::of(Path::new("/no/such/folder/a.csv")).unwrap_err().to_string();
        assert!(error.starts_with("/no/such/folder/a.csv: cannot be written (No such file or directory); "), "{error}");
    }
}
