//! The hands of the bench: what is to be done to the device's power, to the interface or on the bus enters; processes,
//! commands and frames of a second node leave.

use std::io;
use std::process::{Child, Command, Stdio};

use crate::bus::port::Port;

/// What a harness can do beside talking.
pub trait Rig {
    /// Gives the device power, or cuts it.
    ///
    /// # Errors
    /// The device cannot be started or ended.
    fn power(&mut self, on: bool) -> io::Result<()>;

    /// Takes the interface up or down.
    ///
    /// # Errors
    /// That is not allowed.
    fn interface(&mut self, up: bool) -> io::Result<()>;

    /// A node of its own that means no good.
    ///
    /// # Errors
    /// It cannot get onto the bus.
    fn injector(&mut self) -> io::Result<&mut dyn Port>;

    /// How the device ended by itself, if it did.
    fn has_ended(&mut self) -> Option<String>;
}

/// Runs the device's command, `$0`, until it ends or the harness does: then nobody holds the other end of the pipe any more that
/// is its stdin, and its whole group is killed. A harness that is interrupted could not do that itself.
const LEASH: &str = r#"exec 3<&0 </dev/null; { cat <&3 >/dev/null; kill -KILL 0; } & exec 3<&-; eval "$0""#;

/// The rig of a machine with a CAN interface. The device is a command, or somebody else's.
pub struct MachineRig {
    interface: String,
    command: Option<String>,
    device: Option<Child>,
    /// The command that switches the interface; how it ended shows when it is switched again.
    switching: Option<Child>,
    injector: Option<Box<dyn Port>>,
}

impl MachineRig {
    /// On that interface; a device that is a command is not started yet.
    #[must_use]
    pub fn new(interface: &str, command: Option<String>) -> Self {
        Self { interface: interface.into(), command, device: None, switching: None, injector: None }
    }

    fn end(&mut self) -> io::Result<()> {
        let Some(mut device) = self.device.take() else { return Ok(()) };
        // The whole group: the device may be a shell with an emulator in it.
        end_group(&device)?;
        device.wait().map(|_| ())
    }
}

impl Rig for MachineRig {
    fn power(&mut self, on: bool) -> io::Result<()> {
        self.end()?;
        let Some(command) = self.command.as_ref().filter(|_| on) else { return Ok(()) };
        let mut shell = Command::new("sh");
        shell.args(["-c", LEASH, command]).stdin(Stdio::piped()).stdout(io::stderr());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut shell, 0);
        self.device = Some(shell.spawn()?);
        Ok(())
    }

    fn interface(&mut self, up: bool) -> io::Result<()> {
        let last = self.switching.take().map_or(Ok(()), finished);
        let state = if up { "up" } else { "down" };
        let mut command = Command::new("ip");
        command.args(["link", "set", &self.interface, state]).stdin(Stdio::null()).stderr(Stdio::piped());
        // Nobody waits for it: that would make the harness late.
        self.switching = Some(command.spawn()?);
        last
    }

    fn injector(&mut self) -> io::Result<&mut dyn Port> {
        if self.injector.is_none() {
            let port = crate::bus::open(&self.interface).map_err(|error| io::Error::other(error.to_string()))?;
            #[cfg(target_os = "linux")]
            port.hear_only([])?;
            self.injector = Some(Box::new(port));
        }
        match &mut self.injector {
            Some(port) => Ok(port.as_mut()),
            None => Err(io::ErrorKind::NotFound.into()),
        }
    }

    fn has_ended(&mut self) -> Option<String> {
        let status = self.device.as_mut()?.try_wait().ok()??;
        self.device = None;
        Some(status.to_string())
    }
}

impl Drop for MachineRig {
    fn drop(&mut self) {
        // Nobody is left to be told.
        let _ = self.end();
        let _ = self.switching.take().map(finished);
    }
}

/// What a command has to say against itself.
fn finished(command: Child) -> io::Result<()> {
    let output = command.wait_with_output()?;
    if output.status.success() {
        return Ok(());
    }
    Err(io::Error::other(String::from_utf8_lossy(&output.stderr).trim().to_owned()))
}

#[cfg(unix)]
fn end_group(device: &Child) -> io::Result<()> {
    let status =
        Command::new("kill").args(["-KILL", "--", &format!("-{}", device.id())]).stderr(Stdio::null()).status()?;
    // A group that has ended already is what was wanted.
    let _ = status;
    Ok(())
}

#[cfg(not(unix))]
fn end_group(_: &Child) -> io::Result<()> {
    Ok(())
}
