"""Gait files and LibreOffice Calc: we read what Calc saves, and Calc shows what we write.

Calc saved the files in `files/`; `files/make_files.py` makes them.
"""

import io
import math
import shutil
import subprocess
from importlib.resources import files as package_files
from pathlib import Path

import openpyxl
import pytest
from waiting import LIMIT_S

from lacoc_shared.gait.text import read_gait
from lacoc_shared.gait.workbook import INPUT_SHEET
from lacoc_shared.gait.workbook.file import read_gait_file, write_workbook

FILES = Path(__file__).parent / "files"
TEXTS = {
    "utf-8": FILES / "calc-utf-8-Loco-data.txt",
    "utf-16": FILES / "calc-utf-16-Loco-data.txt",
    "cp932": FILES / "calc-shift-jis-Loco-data.txt",
}
# Calc's options: write every sheet as tab-separated UTF-8, with the cells as they are shown.
CSV = "csv:Text - txt - csv (StarCalc):9,34,76,1,,0,false,true,false,false,false,-1"

needs_calc = pytest.mark.skipif(
    shutil.which("soffice") is None, reason="needs LibreOffice Calc (soffice) to open our workbook"
)


@pytest.mark.parametrize("encoding", TEXTS)
def test_text_saved_by_calc(encoding, workshop, legs):
    """Text that Calc saves as UTF-8, UTF-16 or Shift-JIS reads as the workshop's table."""
    path = TEXTS[encoding]
    assert "関節番号" in path.read_bytes().decode(encoding)
    assert read_gait_file(path, legs=legs) == workshop


def test_the_texts_differ_as_bytes():
    """The three text files differ, so they really are in three encodings."""
    assert len({path.read_bytes() for path in TEXTS.values()}) == 3


def test_workbook_saved_by_calc(workshop, legs):
    """The workbook that Calc saves reads as the workshop's table."""
    path = FILES / "calc.xlsx"
    assert read_gait_file(path, legs=legs) == workshop
    assert openpyxl.load_workbook(path).sheetnames == ["EX (input)", "Loco-data"]


def test_the_workbook_that_ships_with_the_hexapod(workshop, legs):
    """The hexapod's Loco-data.xlsx holds the workshop's table in the cells that we write."""
    path = package_files("lacoc_robots") / "samples" / "hexapod" / "Loco-data.xlsx"
    data = path.read_bytes()
    assert read_gait_file(Path(str(path)), legs=legs) == workshop
    ours = openpyxl.load_workbook(io.BytesIO(write_workbook(workshop, legs)))
    shipped = openpyxl.load_workbook(io.BytesIO(data))
    for sheet in ours:
        assert list(shipped[sheet.title].values) == list(sheet.values)


@needs_calc
@pytest.mark.slow
def test_calc_shows_the_values_of_our_workbook(tmp_path, workshop, legs):
    """Calc shows the values of both our sheets; after an edit, the formulas show the new value."""
    data = write_workbook(workshop, legs)
    (tmp_path / "ours.xlsx").write_bytes(data)
    book = openpyxl.load_workbook(io.BytesIO(data))
    book[INPUT_SHEET]["B2"] = -22.5
    book[INPUT_SHEET].insert_rows(4)  # a blank row: the formulas mirror cells by their place
    book.save(tmp_path / "edited.xlsx")
    subprocess.run(
        [
            "soffice",
            "--headless",
            f"-env:UserInstallation={(tmp_path / 'profile').as_uri()}",
            *("--convert-to", CSV),
            *("--outdir", str(tmp_path)),
            *(str(tmp_path / name) for name in ("ours.xlsx", "edited.xlsx")),
        ],
        check=True,
        capture_output=True,
        timeout=LIMIT_S,
    )
    for sheet in ("EX (input)", "Loco-data"):
        ours = tmp_path / f"ours-{sheet}.csv"
        assert read_gait(ours.read_bytes(), ours.name, legs=legs) == workshop
    edited = read_gait((tmp_path / "edited-Loco-data.csv").read_bytes(), "edited", legs=legs)
    assert edited.postures[0][0] == math.radians(-22.5)
    assert edited.postures[0][1:] == workshop.postures[0][1:]
    assert {k: p for k, p in edited.postures.items() if k} == {
        k: p for k, p in workshop.postures.items() if k
    }
