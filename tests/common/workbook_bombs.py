"""Small workbooks that need endless memory or time of who reads them without care."""

import io
import zipfile


def zipped(parts: dict[str, bytes]) -> bytes:
    """Return a zip file with these parts."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return stream.getvalue()


def parts_of(data: bytes) -> dict[str, bytes]:
    """Return the files in a workbook."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def with_cells(data: bytes, cells: str) -> dict[str, bytes]:
    """Return the files of a workbook with a row of cells at the end of its first sheet."""
    parts = parts_of(data)
    sheet = parts["xl/worksheets/sheet1.xml"]
    row = f'<row r="20">{cells}</row></sheetData>'.encode()
    parts["xl/worksheets/sheet1.xml"] = sheet.replace(b"</sheetData>", row)
    return parts


def with_formulas(data: bytes, length: int, cells: int) -> bytes:
    """Return a workbook in which many cells share one long formula."""
    long = f'<c r="A20"><f t="shared" ref="A20:CV500" si="7">{"+A1" * (length // 3)}</f></c>'
    return zipped(with_cells(data, long + '<c><f t="shared" si="7"/></c>' * cells))


def with_text(data: bytes, length: int, cells: int) -> bytes:
    """Return a workbook in which many cells show one long text."""
    parts = with_cells(data, '<c t="s"><v>0</v></c>' * cells)
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    text = f"<si><t>{'4' * length}</t></si>" * 40
    parts["xl/sharedStrings.xml"] = f'<sst xmlns="{main}">{text}</sst>'.encode()
    return zipped(parts)


def with_formats(data: bytes, formats: int, cells: int) -> bytes:
    """Return a workbook with many long number formats, and many styles with them."""
    parts = parts_of(data)
    numbers = "".join(
        f'<numFmt numFmtId="{200 + n}" formatCode="{n}{"0" * 8000}"/>' for n in range(formats)
    )
    styles = "".join(f'<xf numFmtId="{200 + n % formats}"/>' for n in range(cells))
    parts["xl/styles.xml"] = (
        '<styleSheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'
        f"<numFmts>{numbers}</numFmts><cellXfs>{styles}</cellXfs></styleSheet>"
    ).encode()
    return zipped(parts)


def with_sheets(data: bytes, sheets: int) -> bytes:
    """Return a workbook that names its first sheet many times; each is opened."""
    parts = parts_of(data)
    more = "".join(f'<sheet name="n{n}" sheetId="{n + 9}" r:id="rId1"/>' for n in range(sheets))
    book = parts["xl/workbook.xml"].replace(b"</sheets>", f"{more}</sheets>".encode())
    return zipped(parts | {"xl/workbook.xml": book})
