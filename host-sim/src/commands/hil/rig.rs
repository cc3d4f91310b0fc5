//! The rig of the bench: requests about the device's power, the interface and the bus enter; processes, commands and
//! frames of a second node leave.

use std::io;
use std::process::{Child, Command, Stdio};

use crate::bus::port::Port;

/// What a harness can do besides sending frames.
pub trait Rig {
    /// Switches the device's power on or off.
    ///
    /// # Errors
    /// The device cannot be started or ended.
    fn power(&mut self, on: bool) -> io::Result<()>;

    /// Takes the interface up or down.
    ///
    /// # Errors
    /// The system does not allow it.
    fn interface(&mut self, up: bool) -> io::Result<()>;

    /// The port of a second node, for frames of a hostile node.
    ///
    /// # Errors
    /// The node cannot be opened on the bus.
    fn injector(&mut self) -> io::Result<&mut dyn Port>;

    /// How the device ended, if it ended by itself.
    fn has_ended(&mut self) -> Option<String>;
}

/// Runs the device's command, `$0`, until it ends or the harness ends. When the harness ends, the other end of the pipe
/// that is this shell's stdin closes, and the whole process group is killed. A harness that is interrupted could not
/// kill it itself.
const LEASH: &str = r#"exec 3<&0 </dev/null; { cat <&3 >/dev/null; kill -KILL 0; } & exec 3<&-; eval "$0""#;

/// The rig of a machine with a CAN interface. The device is started by a command, or is run externally.
pub struct MachineRig {
    interface: String,
    command: Option<String>,
    device: Option<Child>,
    /// The command that switches the interface. Its result is checked at the next switching.
    switching: Option<Child>,
    injector: Option<Box<dyn Port>>,
}

impl MachineRig {
    /// The rig on an interface. A device that is a command is not started yet.
    #[must_use]
    pub fn new(interface: &str, command: Option<String>) -> Self {
        Self { interface: interface.into(), command, device: None, switching: None, injector: None }
    }

    fn end(&mut self) -> io::Result<()> {
        let Some(mut device) = self.device.take() else { return Ok(()) };
        // The whole group, because the device may be a shell with an emulator in it.
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
        // The harness does not wait for it, because that would make the harness late.
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
        // There is no caller left to report an error to.
        let _ = self.end();
        let _ = self.switching.take().map(finished);
    }
}

/// The error of a command that has ended.
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
    // The group may have ended already, which is what was wanted.
    let _ = status;
    Ok(())
}

#[cfg(not(unix))]
fn end_group(_: &Child) -> io::Result<()> {
    Ok(())
}
