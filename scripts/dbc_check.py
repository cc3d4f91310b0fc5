"""dbc_check.py FILE...: the DBC files as other tools read them.

cantools reads each file strictly. canmatrix turns it into a DBC, a KCD, a SYM and an ARXML file, and each of these, read back, has
the same identifiers, lengths and signals, and is of CAN FD or not, as far as canmatrix keeps these in that format. Every message and
signal has a comment, every attribute of a message stands in the file, and in a file of CAN FD every frame is of CAN FD. A FIBEX file has
every frame, and every signal that selects no part; canmatrix writes it, and does not read back what has no receiver. A warning of either
tool is a failure.
Exit code: 0 all is the same, 1 something is not.
"""

import logging
import sys
import tempfile
import xml.etree.ElementTree
from pathlib import Path

import canmatrix.convert
import canmatrix.formats
import cantools


class Warnings(logging.Handler):
    """What the tools had to say."""

    def __init__(self):
        super().__init__(logging.WARNING)
        self.said = []

    def emit(self, record):
        self.said.append(f"{record.name}: {record.getMessage()}")


def frames(path):
    """Every frame of a file, as canmatrix reads it."""
    return next(iter(canmatrix.formats.loadp(str(path)).values())).frames


def kinds(path):
    """The kind of bus of every frame of a file."""
    return {(frame.arbitration_id.id, frame.arbitration_id.extended, "CAN FD" if frame.is_fd else "CAN") for frame in frames(path)}


def signals(path, is_whole=True):
    """Every signal of a file; if not whole, by its place alone."""
    return {
        (
            frame.arbitration_id.id,
            frame.arbitration_id.extended,
            frame.size,
            signal.start_bit,
        )
        + ((frame.name, signal.size, signal.is_signed, float(signal.factor), float(signal.offset)) if is_whole else ())
        # A SYM file has a name of its own for the signal that selects the part.
        + ((signal.name,) if is_whole and not signal.is_multiplexer else ())
        for frame in frames(path)
        for signal in frame.signals
    }


# In an ARXML file canmatrix keeps one definition of all signals of one name, and it reads no scales back.
FORMATS = {"dbc": True, "kcd": True, "sym": True, "arxml": False}

# KCD and SYM do not keep the kind of bus.
KINDS = {"dbc", "arxml"}


def fibex(path):
    """The identifiers and the number of signals of a FIBEX file."""
    places = {"fx": "http://www.asam.net/xml/fbx"}
    root = xml.etree.ElementTree.parse(path).getroot()
    identifiers = root.findall(".//fx:FRAME-TRIGGERING/fx:IDENTIFIER/fx:IDENTIFIER-VALUE", places)
    return sorted(int(value.text) for value in identifiers), len(root.findall(".//fx:SIGNAL-INSTANCE", places))


def check(path):
    """What is wrong with a file."""
    database = cantools.database.load_file(path, strict=True)
    wrong = []
    named = [signal for message in database.messages for signal in message.signals]
    wrong += [f"{item.name} has no comment" for item in [*database.messages, *named] if not item.comment]
    bus = database.dbc.attributes["BusType"].value
    wrong += [f"{number:#x} is of {kind}, and the bus of {bus}" for number, _, kind in sorted(kinds(path)) if kind != bus]
    defined = {name for name, definition in database.dbc.attribute_definitions.items() if definition.kind == "BO_"}
    for message in database.messages:
        wrong += [f"{message.name} has no {name}" for name in sorted(defined - message.dbc.attributes.keys())]
    with tempfile.TemporaryDirectory() as folder:
        for suffix, is_whole in FORMATS.items():
            other = Path(folder) / f"other.{suffix}"
            canmatrix.convert.convert(str(path), str(other))
            ours, theirs = signals(path, is_whole), signals(other, is_whole)
            wrong += [f"not in {suffix}: {signal}" for signal in sorted(ours - theirs)]
            wrong += [f"only in {suffix}: {signal}" for signal in sorted(theirs - ours)]
            if suffix in KINDS:
                wrong += [f"not so in {suffix}: {kind}" for kind in sorted(kinds(path) ^ kinds(other))]
        other = Path(folder) / "other.xml"
        with open(other, "wb") as file:
            canmatrix.formats.dump(next(iter(canmatrix.formats.loadp(str(path)).values())), file, "fibex")
        identifiers = sorted(frame.arbitration_id.id for frame in frames(path))
        # What selects the part is no signal there.
        expected = identifiers, sum(not signal.is_multiplexer for signal in named)
        if fibex(other) != expected:
            wrong.append(f"in FIBEX {fibex(other)}, and not {expected}")
    print(f"{path}: {len(database.messages)} messages, {len(named)} signals, the same in {', '.join(FORMATS)}; all in FIBEX")
    return wrong


def main(paths):
    warnings = Warnings()
    logging.getLogger().addHandler(warnings)
    wrong = [f"{path}: {what}" for path in paths for what in check(path)] + warnings.said
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main([Path(name) for name in sys.argv[1:]]))
