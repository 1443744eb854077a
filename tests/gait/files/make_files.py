"""Enter the workshop's table in LibreOffice Calc and save it in every way a student may.

    /usr/bin/python3 tests/gait/files/make_files.py

This needs Debian's libreoffice-calc and python3-uno. The script types each cell as a person would.
The legend's labels are in Japanese, so that the encodings of the text files differ. The script
writes the files beside itself, and they are committed. Calc adds the sheet's name to the names of
the text files.
"""

import subprocess
import tempfile
import time
import uuid
from pathlib import Path

import uno
from com.sun.star.beans import PropertyValue
from com.sun.star.connection import NoConnectException

HERE = Path(__file__).resolve().parent
SAMPLE = HERE.parents[2] / "robots/lacoc_robots/samples/hexapod/Loco-data.txt"
JAPANESE = {"ID of Joint": "関節番号", "Position": "脚の位置", "Root": "付け根"}

# The options: tab as separator, double quotes, the character set's number, start in row 1; then:
# write cells as they are shown, and write the second sheet. See "Filter Options for CSV" in
# LibreOffice's help.
TEXT = "9,34,{charset},1,,0,false,true,false,false,false,2"
CHARSETS = {"utf-8": 76, "utf-16": 65535, "shift-jis": 64}


def properties(**values):
    """Return named values in the form in which LibreOffice takes arguments."""
    return tuple(PropertyValue(Name=name, Value=value) for name, value in values.items())


def connect(pipe, process):
    """Wait until the started LibreOffice listens; return its desktop."""
    context = uno.getComponentContext()
    resolver = context.ServiceManager.createInstance("com.sun.star.bridge.UnoUrlResolver")
    while process.poll() is None:
        try:
            office = resolver.resolve(f"uno:pipe,name={pipe};urp;StarOffice.ComponentContext")
        except NoConnectException:
            time.sleep(0.1)
        else:
            return office.ServiceManager.createInstance("com.sun.star.frame.Desktop")
    raise SystemExit("LibreOffice ended before it listened")


def enter_table(document):
    """Type the table into one sheet, and formulas that mirror it into the other sheet."""
    sheets = document.Sheets
    sheets.getByIndex(0).Name = "EX (input)"
    sheets.insertNewByName("Loco-data", 1)
    edited, mirror = sheets.getByName("EX (input)"), sheets.getByName("Loco-data")
    lines = SAMPLE.read_text().splitlines()
    for row, line in enumerate(lines):
        for column, cell in enumerate(line.split("\t")):
            if cell:
                edited.getCellByPosition(column, row).setFormula(JAPANESE.get(cell, cell))
                name = edited.getCellByPosition(column, row).AbsoluteName.split(".")[1]
                reference = name.replace("$", "")
                mirror.getCellByPosition(column, row).setFormula(f"=$'EX (input)'.{reference}")


def main():
    """Start LibreOffice Calc and let it save the files."""
    pipe = f"lacoc-{uuid.uuid4().hex}"
    with tempfile.TemporaryDirectory() as profile:
        process = subprocess.Popen(
            [
                "soffice",
                "--headless",
                "--norestore",
                f"-env:UserInstallation={Path(profile).as_uri()}",
                f"--accept=pipe,name={pipe};urp;",
            ]
        )
        desktop = connect(pipe, process)
        document = desktop.loadComponentFromURL(
            "private:factory/scalc", "_blank", 0, properties(Hidden=True)
        )
        enter_table(document)
        for name, charset in CHARSETS.items():
            document.storeToURL(
                (HERE / f"calc-{name}.txt").as_uri(),
                properties(
                    FilterName="Text - txt - csv (StarCalc)",
                    FilterOptions=TEXT.format(charset=charset),
                ),
            )
        document.storeToURL(
            (HERE / "calc.xlsx").as_uri(), properties(FilterName="Calc Office Open XML")
        )
        document.close(True)
        desktop.terminate()
        process.wait()


if __name__ == "__main__":
    main()
