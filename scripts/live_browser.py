"""What the checks of the page of `live` share: a running program, a browser, a page that counts what its console says.

Each check is called as `CHECK HOLDOVER_SIM CHROMIUM FOLDER`; its pictures go to FOLDER.
"""

import os
import subprocess
import sys
import time
from contextlib import contextmanager

from playwright.sync_api import sync_playwright

PROGRAM, CHROMIUM, FOLDER = sys.argv[1:4]
FRAMES_A_SECOND = 30


class Address(str):
    """The address of a `live`, which knows what its process has cost."""

    def __new__(cls, text, pid):
        address = super().__new__(cls, text)
        address.pid = pid
        return address

    def core_s(self):
        """Time that it has had a core, all threads together."""
        with open(f"/proc/{self.pid}/stat", encoding="ascii") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@contextmanager
def live(*arguments):
    """The address of a running `live`."""
    command = [PROGRAM, "live", "--no-browser", "--port", "0", *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield Address(process.stdout.readline().strip(), process.pid)
        finally:
            process.terminate()


@contextmanager
def chromium():
    """A browser without a screen."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--enable-unsafe-swiftshader"])
        yield browser
        browser.close()


def holds(what, fact):
    print(f"{'holds' if fact else 'FAILS'}: {what}", flush=True)
    if not fact:
        sys.exit(1)


class Page:
    """A page that counts what its console says."""

    def __init__(self, browser, address, script=None, **shape):
        self.page = browser.new_page(**shape)
        self.faults = []
        if script:
            self.page.add_init_script(script)
        self.page.on("console", lambda said: self.faults.append(said.text) if said.type == "error" else None)
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))
        self.page.goto(address)
        self.page.wait_for_selector("html[data-ready]")
        self.until("state.scene")

    def __getattr__(self, name):
        return getattr(self.page, name)

    def read(self, expression):
        return self.page.evaluate(f"(({{ state }}) => {expression})(globalThis.holdover)")

    def until(self, expression, seconds=15):
        """Waits until something is so, and returns whether it came to be."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.read(expression):
                return True
            time.sleep(0.02)
        return False

    def show_on(self, run_seconds, seconds=60):
        """Waits until so much of the run was shown. On a busy machine the scene may still be that of before, and then jump."""
        end, shown, before = time.monotonic() + seconds, 0, self.read("state.scene.at_s")
        while shown < run_seconds and time.monotonic() < end:
            time.sleep(0.02)
            now = self.read("state.scene.at_s")
            shown += now - before if 0 < now - before < 2 else 0
            before = now

    def seen(self, vehicle, what):
        return self.read(f"state.scene.byId.get({vehicle})?.{what}")

    def frames_a_second(self, seconds):
        """What the display draws, and what the server sends."""
        count = "[globalThis.holdover.frames(), globalThis.holdover.heard()]"
        (drawn, heard), began = self.page.evaluate(count), time.monotonic()
        time.sleep(seconds)
        passed = time.monotonic() - began
        drawn_later, heard_later = self.page.evaluate(count)
        return (drawn_later - drawn) / passed, (heard_later - heard) / passed

    def order(self, text):
        return self.page.evaluate("(body) => fetch('/order', { method: 'POST', body }).then((answer) => answer.status)", text)

    def figures(self, vehicle):
        target = self.seen(vehicle, "target")
        low, high = target["bound_m"]
        return abs(target["error_m"]), high - low, target["age_s"]
