"""Reads the values that a C file gives to names: `#define W 0.1`, `double a = 2*W, b[2] = {1, W};`.

Only declarations outside of functions are read. An expression may have numbers, names, brackets, +
- * / and the functions of `_CALLS`. Nothing is compiled or run. Lines that `#if 0` leaves out are
not read; of another `#if` all branches are, because it is not known which condition holds.
"""

import math
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import NamedTuple, TypeAlias

from lacoc_shared.words import Phrase, say

Value: TypeAlias = "float | int | tuple[Value, ...]"

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", re.DOTALL)
_TOKEN = re.compile(
    r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[fFlLuU]*"
    r"|(?P<name>[A-Za-z_]\w*)|(?P<sign>\.\.\.|[^\sA-Za-z_0-9])"
)
_DEFINE = re.compile(r"[ \t]*#[ \t]*define[ \t]+([A-Za-z_]\w*)(?!\()[ \t]+(.+)")
_CONDITION = re.compile(r"[ \t]*#[ \t]*(if|ifdef|ifndef|elif|else|endif)\b(.*)")
_KNOWN_CONDITIONS = {"0": False, "1": True}
_TYPES = {"dReal", "double", "float", "int", "long", "unsigned", "short", "dVector3"}
_BEFORE_TYPES = {"const", "static", "extern", "volatile"}
_CALLS: Mapping[str, Callable[[float], float]] = {
    name: getattr(math, name) for name in ("sin", "cos", "tan", "sqrt", "fabs", "atan")
}
_DEEPEST = 40
"""How deep brackets, and macros, may be nested."""
_MOST_TOKENS = 100_000

_CONSTANTS: dict[str, Value] = {"M_PI": math.pi, "M_PI_2": math.pi / 2, "M_PI_4": math.pi / 4}


class Unread(NamedTuple):
    """A declaration of a C file that could not be read."""

    name: str
    line: int
    """Line of the declaration, from 1."""
    text: str
    why: Phrase


class CValues(NamedTuple):
    """The values that were read from one or several C files."""

    values: dict[str, Value]
    lines: dict[str, int]
    """Number of the line, from 1, from which the value of each name comes."""
    others: dict[str, int]
    """For each name with several values: number of a line whose value does not count."""
    unread: list[Unread]


class _Token(NamedTuple):
    kind: str
    text: str
    line: int


class _Branch(NamedTuple):
    """A branch of an `#if`: the lines up to the next `#elif`, `#else` or `#endif`."""

    is_read: bool
    is_decided: bool
    """Whether this branch or one before it surely holds, so that a compiler reads no later one."""


class _CanNotRead(Exception):
    """Raised when a C expression contains something that this module does not read."""

    def __init__(self, why: Phrase) -> None:
        super().__init__(why.code)
        self.why = why


def read_c(text: str) -> CValues:
    """Read the values that a C file defines and declares outside of functions."""
    defines: list[tuple[str, list[_Token]]] = []
    code: list[str] = []
    for number, line in enumerate(_read_lines(_lines(_COMMENT.sub(_blank, text))), 1):
        defined = _DEFINE.match(line)
        if defined:
            defines.append((defined[1], _tokens(defined[2], number)))
        code.append("" if line.lstrip().startswith("#") else line)
    found = CValues({}, {}, {}, [])
    macros = dict(defines)
    for name, tokens in defines:
        _take(found, name, tokens, macros)
    _Declarations(_tokens("\n".join(code), 1), found, macros).read()
    return found


def _lines(text: str) -> Iterator[str]:
    """Yield the lines of a text; a line that continues after a backslash is joined.

    After a joined line empty lines follow, so that the numbers of lines stay right.
    """
    open_lines: list[str] = []
    for line in text.splitlines():
        open_lines.append(line.rstrip().removesuffix("\\"))
        if not line.rstrip().endswith("\\"):
            yield " ".join(open_lines)
            yield from [""] * (len(open_lines) - 1)
            open_lines = []
    yield " ".join(open_lines)


def _read_lines(lines: Iterable[str]) -> Iterator[str]:
    """Yield the lines of a C file; those that a compiler surely leaves out are empty."""
    branches = [_Branch(True, False)]  # the whole file, then from the outermost `#if` inward
    for line in lines:
        if found := _CONDITION.match(line):
            word, condition = found[1], found[2].strip(" \t()")
            holds = True if word == "else" else _KNOWN_CONDITIONS.get(condition)
            is_decided = False
            if not word.startswith("if") and len(branches) > 1:
                is_decided = branches.pop().is_decided
            if word != "endif":
                is_read = branches[-1].is_read and not is_decided and holds is not False
                branches.append(_Branch(is_read, is_decided or holds is True))
        yield line if branches[-1].is_read else ""


def _blank(match: re.Match[str]) -> str:
    """Return the text that takes the place of a comment or a string: only its line ends."""
    return " " + "\n" * match[0].count("\n")


def _tokens(text: str, line: int) -> list[_Token]:
    tokens = []
    at = 0
    for match in _TOKEN.finditer(text):
        line += text.count("\n", at, match.start())
        at = match.start()
        kind = match.lastgroup or ""
        tokens.append(_Token(kind, match[kind], line))
        if len(tokens) >= _MOST_TOKENS:
            break
    return tokens


def _expanded(
    tokens: Iterable[_Token], macros: Mapping[str, list[_Token]], within: tuple[str, ...] = ()
) -> Iterator[_Token]:
    """Replace the names of macros by the macros' tokens, as a compiler does."""
    for token in tokens:
        if token.text in macros and token.text not in within and len(within) < _DEEPEST:
            yield from _expanded(macros[token.text], macros, (*within, token.text))
        else:
            yield token


def _take(
    found: CValues, name: str, tokens: Sequence[_Token], macros: Mapping[str, list[_Token]]
) -> None:
    """Compute the value that a C file gives to a name, and store it in `found`.

    If it can't be read, note this in `found`.
    """
    line = tokens[0].line if tokens else 0
    try:
        whole = [*islice(_expanded(tokens, macros, (name,)), _MOST_TOKENS)]
        value = _checked(_Expression(whole, found.values))
    except _CanNotRead as error:
        text = f"{name} = {' '.join(token.text for token in tokens)}"
        found.unread.append(Unread(name, line, text, error.why))
        return
    if found.values.get(name, value) != value:
        found.others[name] = found.lines[name]
    found.values[name] = value
    found.lines[name] = line


def _checked(expression: "_Expression") -> Value:
    """Return the value of an expression; all its numbers are finite.

    Raises:
        _CanNotRead: if there is no such value.
    """
    try:
        value = expression.value()
    except (OverflowError, ValueError):  # Python's own: infinite, or thousands of digits
        raise _CanNotRead(say("header.too-large")) from None
    if not _is_finite(value):
        raise _CanNotRead(say("header.too-large"))
    return value


def _is_finite(value: Value) -> bool:
    if isinstance(value, tuple):
        return all(map(_is_finite, value))
    return abs(value) <= sys.float_info.max  # also a whole number must be a number in C


class _Declarations:
    """Reads the declarations of a C file one by one, and skips the bodies of functions."""

    def __init__(
        self,
        tokens: list[_Token],
        found: CValues,
        macros: Mapping[str, list[_Token]],
    ) -> None:
        self._tokens = tokens
        self._at = 0
        self._found = found
        self._macros = macros

    def read(self) -> None:
        while self._at < len(self._tokens):
            text = self._tokens[self._at].text
            if text in _TYPES:
                self._at += 1
                self._declarators()
            elif text == "{":
                self._skip_block()
            else:
                self._at += 1

    def _declarators(self) -> None:
        """Read what follows the type in a declaration, such as "a = 1, b[2] = {1, 2};"."""
        while self._at < len(self._tokens):
            token = self._tokens[self._at]
            self._at += 1
            if token.kind != "name":
                if token.text in ("*", ","):
                    continue
                return
            if token.text in _TYPES | _BEFORE_TYPES:
                continue
            while self._here() == "[":
                self._skip_block()
            if self._here() == "(":  # a function
                return
            if self._here() == "=":
                self._at += 1
                begin = self._at
                self._skip_value()
                tokens = self._tokens[begin : self._at]
                _take(self._found, token.text, tokens, self._macros)

    def _here(self) -> str:
        return self._tokens[self._at].text if self._at < len(self._tokens) else ""

    def _skip_value(self) -> None:
        """Skip the value of a declaration: go to the comma or semicolon behind it."""
        depth = 0
        while self._at < len(self._tokens):
            text = self._tokens[self._at].text
            if depth <= 0 and text in ",;":
                return
            depth += (text in "([{") - (text in ")]}")
            self._at += 1

    def _skip_block(self) -> None:
        """Skip a block: from an opening bracket to the token after its closing bracket."""
        depth = 0
        while self._at < len(self._tokens):
            text = self._tokens[self._at].text
            depth += (text in "([{") - (text in ")]}")
            self._at += 1
            if depth <= 0:
                return


class _Expression:
    """Computes the value of one C expression, or of one list in braces."""

    def __init__(self, tokens: Sequence[_Token], known: Mapping[str, Value]) -> None:
        self._tokens = tokens
        self._at = 0
        self._known = known
        self._depth = 0

    def value(self) -> Value:
        """Return the value of the whole expression or list.

        Raises:
            _CanNotRead: if the expression contains something that is not read here.
        """
        value = self._list() if self._here() == "{" else self._sum()
        if self._at < len(self._tokens):
            raise _CanNotRead(say("header.sign", sign=self._here()))
        return value

    def _list(self) -> Value:
        self._take("{")
        items: list[Value] = []
        while self._here() != "}":
            items.append(self._list() if self._here() == "{" else self._sum())
            if self._here() != ",":
                break
            self._take(",")
        self._take("}")
        return tuple(items)

    def _sum(self) -> float | int:
        value = self._product()
        while self._here() in ("+", "-"):
            sign = self._take()
            other = self._product()
            value = value + other if sign == "+" else value - other
        return value

    def _product(self) -> float | int:
        value = self._factor()
        while self._here() in ("*", "/"):
            sign = self._take()
            other = self._factor()
            if sign == "*":
                value = value * other
            elif not other:
                raise _CanNotRead(say("header.by-zero"))
            elif isinstance(value, int) and isinstance(other, int):
                value = int(value / other)  # as C divides whole numbers
            else:
                value = value / other
        return value

    def _factor(self) -> float | int:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise _CanNotRead(say("header.too-deep"))
        try:
            return self._one()
        finally:
            self._depth -= 1

    def _one(self) -> float | int:
        if self._at >= len(self._tokens):
            raise _CanNotRead(say("header.nothing"))
        token = self._tokens[self._at]
        self._at += 1
        if token.text in ("+", "-"):
            return self._factor() if token.text == "+" else -self._factor()
        if token.text == "(":
            if self._here() in _TYPES:  # a cast: (double)1
                kind = self._take()
                self._take(")")
                value = self._factor()
                return int(value) if kind in ("int", "long", "short") else float(value)
            value = self._sum()
            self._take(")")
            return value
        if token.kind == "number":
            return int(token.text) if token.text.isdigit() else float(token.text)
        if token.kind != "name":
            raise _CanNotRead(say("header.sign", sign=token.text))
        if token.text in _CALLS and self._here() == "(":
            self._take("(")
            value = self._sum()
            self._take(")")
            return self._called(token.text, value)
        return self._named(token.text)

    def _called(self, name: str, value: float) -> float:
        try:
            return _CALLS[name](value)
        except ValueError:
            raise _CanNotRead(say("header.sign", sign=f"{name}({value:g})")) from None

    def _named(self, name: str) -> float | int:
        value = self._known.get(name, _CONSTANTS.get(name))
        if value is None:
            raise _CanNotRead(say("header.unknown", name=name))
        while self._here() == "[":
            self._take("[")
            index = self._sum()
            self._take("]")
            if not isinstance(value, tuple) or not 0 <= index < len(value):
                raise _CanNotRead(say("header.no-entry", name=name, index=index))
            value = value[int(index)]
        if isinstance(value, tuple):
            raise _CanNotRead(say("header.a-list", name=name))
        return value

    def _here(self) -> str:
        return self._tokens[self._at].text if self._at < len(self._tokens) else ""

    def _take(self, wanted: str = "") -> str:
        here = self._here()
        if wanted and here != wanted:
            raise _CanNotRead(say("header.wants", wanted=wanted, found=here or say("header.end")))
        self._at += 1
        return here
