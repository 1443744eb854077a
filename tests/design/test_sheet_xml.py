"""Tests that cells are changed in worksheet XML of the styles that different programs write."""

from xml.etree import ElementTree

import pytest

from lacoc_client.workshop.design.saving.sheet_xml import NotEditable, SheetXml

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
PLAIN = f"""<?xml version="1.0" encoding="UTF-8"?>
<worksheet xmlns="{MAIN}" xmlns:y="y"><!-- <row r="9"> -->
<sheetData>
  <row r="2" spans="1:3" ht='12'><c r="A2" s="4" t="s"><v>0</v></c>
  <c r="C2"><f>A2&gt;1</f><v>5</v></c><y:more a="b &gt; c"/></row>
  <row r="4"/>
  <row r="6"><c r="B6" t="inlineStr"><is><t>a &lt; b</t></is></c>
    <c r="D6"/><c r="E6"/><c r="F6"/></row>
</sheetData><mergeCells/></worksheet>"""
PREFIXED = PLAIN.replace("xmlns=", "xmlns:x=")
for _name in ("worksheet", "sheetData", "row", "c", "v", "f", "is", "t", "mergeCells"):
    for _end in (" ", ">", "\n"):
        PREFIXED = PREFIXED.replace(f"<{_name}{_end}", f"<x:{_name}{_end}")
    PREFIXED = PREFIXED.replace(f"</{_name}", f"</x:{_name}").replace(f"<{_name}/", f"<x:{_name}/")
UNNAMED = PLAIN.replace(' r="A2"', "").replace(' r="D6"', "")


def shown(data: bytes) -> dict[str, tuple[str, str, str]]:
    """Return a sheet's cells by address, each with its style, type and text."""
    found = {}
    for row in ElementTree.fromstring(data).iter(f"{{{MAIN}}}row"):
        for cell in row.iter(f"{{{MAIN}}}c"):
            text = "|".join(one.text or "" for one in cell.iter() if one.text)
            found[cell.get("r", "?")] = (cell.get("s", ""), cell.get("t", ""), text)
    return found


@pytest.mark.parametrize("text", [PLAIN, PREFIXED, UNNAMED], ids=["plain", "prefixed", "unnamed"])
def test_cells_are_found_and_changed(text: str) -> None:
    """Cells are changed and added in rows that have cells, are empty, or are missing."""
    sheet = SheetXml(text.encode())
    cells = {cell.place: cell for cell in sheet.cells()}
    assert cells[2, 3].formula is not None
    assert (cells[2, 3].formula.text, cells[2, 3].value) == ("A2>1", "5")
    changed = sheet.edited(
        {
            (2, 1): sheet.number("7"),
            (2, 2): sheet.text("<&>"),
            (4, 3): sheet.number("-1.5"),
            (5, 1): sheet.number("1"),
            (6, 2): sheet.copy(cells[2, 1]),
            (9, 2): sheet.text("last"),
        }
    )
    assert shown(changed) == {
        "A2": ("4", "", "7"),
        "B2": ("", "inlineStr", "<&>"),
        "C2": ("", "", "A2>1|5"),
        "C4": ("", "", "-1.5"),
        "A5": ("", "", "1"),
        "B6": ("4", "s", "0"),
        # A cell without an address stands next to the cell before it.
        "C6" if text == UNNAMED else "D6": ("", "", ""),
        "E6": ("", "", ""),
        "F6": ("", "", ""),
        "B9": ("", "inlineStr", "last"),
    }
    again = changed.decode()
    assert '<y:more a="b &gt; c"/>' in again
    assert "spans" not in again
    assert again.startswith(text[: text.index("<!--")])
    assert again.endswith(text[-30:])


def test_nothing_changed_is_the_same_bytes() -> None:
    """A sheet without changes stays the same, byte for byte."""
    assert SheetXml(PREFIXED.encode()).edited({}) == PREFIXED.encode()


@pytest.mark.parametrize(
    "data",
    [
        PLAIN.encode("utf-16"),
        PLAIN.replace("UTF-8", "Shift_JIS").encode(),
        PLAIN.replace("</row>", "", 1).encode(),
        f'<worksheet xmlns="{MAIN}"><sheetData/></worksheet>'.encode(),
    ],
    ids=["utf-16", "shift-jis", "broken", "empty"],
)
def test_what_can_t_be_edited_is_said(data: bytes) -> None:
    """XML that is not UTF-8 or is broken, and a sheet with no cells, raise `NotEditable`."""
    with pytest.raises(NotEditable):
        SheetXml(data)
