"""The parts of a workbook: the files in its zip, and which of them are its sheets."""

import io
import posixpath
import re
import zipfile
from collections.abc import Mapping
from xml.etree import ElementTree

_DOCUMENT = "/officeDocument"
_CHAIN = "/calcChain"
_WORKSHEET = "/worksheet"
_CALCULATION = re.compile(r"<(\w+:)?calcPr\b[^>]*>")
_FULL = re.compile(r'\sfullCalcOnLoad="[^"]*"')
_BEFORE_CALCULATION = re.compile(
    r"(?s).*(?:</(?:\w+:)?(?:sheets|functionGroups|externalReferences|definedNames)>)"
)


class BookParts:
    """The parts of a workbook: the files in its zip.

    Args:
        data: the .xlsx file; the reader of gait files has checked it and found it harmless.

    Raises:
        Exception: of any kind, if the workbook is broken.
    """

    def __init__(self, data: bytes) -> None:
        self._data = data
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            self._parts = {one.filename: archive.read(one) for one in archive.infolist()}
        self._book = self._of_type("", _DOCUMENT)[0]
        self.sheets = self._sheets()
        """Title of each worksheet -> name of its part, in the order of the workbook."""

    def part(self, name: str) -> bytes:
        """Return the content of a part of the workbook."""
        return self._parts[name]

    def defined_names(self) -> dict[str, str]:
        """Return the names that the workbook defines: name -> the formula that it stands for."""
        book = ElementTree.fromstring(self._parts[self._book])
        found = (one for one in book.iter() if one.tag.endswith("}definedName"))
        return {one.get("name", ""): one.text or "" for one in found}

    def packed(self, changed: Mapping[str, bytes], *, formulas: bool, chain: bool) -> bytes:
        """Return the bytes of the workbook after some of its parts were changed.

        Args:
            changed: name of each changed part -> its content.
            formulas: whether programs must calculate all formulas when they open the workbook.
            chain: whether to remove the stored list of cells with formulas (calcChain), because a
                formula has become a number. Programs make this list again.
        """
        parts = {**self._parts, **changed}
        if formulas:
            parts[self._book] = _calculated(parts[self._book].decode()).encode()
        if chain:
            for name in self._of_type(self._book, _CHAIN):
                del parts[name]
                relations = _relations_name(self._book)
                parts[relations] = _without(parts[relations], rb"Relationship", _CHAIN.encode())
                types = "[Content_Types].xml"
                parts[types] = _without(parts[types], rb"Override", b"/" + name.encode())
        stream = io.BytesIO()
        with (
            zipfile.ZipFile(io.BytesIO(self._data)) as before,
            zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as after,
        ):
            for one in before.infolist():
                if one.filename in parts:
                    after.writestr(one, parts[one.filename], one.compress_type)
        return stream.getvalue()

    def _sheets(self) -> dict[str, str]:
        targets = dict(self._relations(self._book, _WORKSHEET))
        book = ElementTree.fromstring(self._parts[self._book])
        found = {}
        for one in book.iter():
            if one.tag.endswith("}sheet"):
                ids = [value for key, value in one.attrib.items() if key.endswith("}id")]
                if ids and ids[0] in targets:
                    found[one.get("name", "")] = targets[ids[0]]
        return found

    def _of_type(self, part: str, kind: str) -> list[str]:
        return [target for _, target in self._relations(part, kind)]

    def _relations(self, part: str, kind: str) -> list[tuple[str, str]]:
        """Return the id and the target part of each relation of one kind that a part has.

        The part "" stands for the whole file.
        """
        name = _relations_name(part)
        if name not in self._parts:
            return []
        return [
            (one.get("Id", ""), posixpath.normpath(_joined(part, one.get("Target", ""))))
            for one in ElementTree.fromstring(self._parts[name])
            if one.get("Type", "").endswith(kind)
        ]


def _relations_name(part: str) -> str:
    folder, name = posixpath.split(part)
    return posixpath.join(folder, "_rels", f"{name}.rels")


def _joined(part: str, target: str) -> str:
    if target.startswith("/"):
        return target[1:]
    return posixpath.join(posixpath.dirname(part), target)


def _calculated(book: str) -> str:
    """Change a workbook's XML so that programs calculate all formulas when they open it."""
    found = _CALCULATION.search(book)
    full = ' fullCalcOnLoad="1"'
    if found is not None:
        tag = _FULL.sub("", found[0])
        start = re.match(r"<(\w+:)?calcPr", tag)
        assert start is not None
        tag = start[0] + full + tag[start.end() :]
        return book[: found.start()] + tag + book[found.end() :]
    place = _BEFORE_CALCULATION.match(book)
    if place is None:
        return book
    prefix = re.search(r"</(\w+:)?\w+>$", place[0])
    colon = (prefix[1] or "") if prefix else ""
    return f"{place[0]}<{colon}calcPr{full}/>{book[place.end() :]}"


def _without(xml: bytes, element: bytes, ending: bytes) -> bytes:
    """Remove from XML each `element` with an attribute that ends with `ending`; return the rest."""
    pattern = rb"<(?:\w+:)?" + element + rb"\b[^>]*" + re.escape(ending) + rb"\"[^>]*/>"
    return re.sub(pattern, b"", xml)
