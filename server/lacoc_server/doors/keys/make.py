"""Makes a contest's keys and invitations, in a folder beside its contest file."""

import itertools
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from lacoc_server.doors.keys.certificates import Authority, Pair, hosts_of, utc_now
from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.file import Contest
from lacoc_shared.contest.invitation import Access, invitation_text
from lacoc_shared.contest.key_folder import KeyFolder
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.mistakes import UserError
from lacoc_shared.network import address
from lacoc_shared.words import say

_ALWAYS = ("localhost", "127.0.0.1", "::1")
_TABLE = "[contest]"
_FOLDER = "keys"


class Made(NamedTuple):
    """The result of `make_keys`."""

    folder: KeyFolder
    invitations: list[Access]
    hosts: list[str]
    """Names and IP addresses in the courts' certificate."""
    ends: str
    """Last day of all certificates (ISO 8601)."""
    handed_out_hold: bool
    """True if there were keys before and they were kept: their invitations stay valid."""
    kept: Path | None
    """Folder of the replaced keys; None: none were replaced."""


def make_keys(file: Path, hosts: Sequence[str], renew: bool) -> Made:
    """Make a contest's keys, or add what is new; name their folder in the contest file.

    The authority is made only once, so invitations that were handed out stay valid. The courts'
    certificate and the invitations are written again each time, from what the contest file says.

    Args:
        file: the contest file.
        hosts: names and IP addresses of the courts' machine; invitations use the first one for a
            court without an address in the file.
        renew: replace all keys; the old folder is kept under another name.

    Raises:
        UserError: if the file or the keys can't be read or written, if the authority has expired,
            or if a court has no address.
    """
    hosts = [address.host(address.endpoint(host)) for host in hosts]
    data, contest = _with_entry(file)
    folder = contest.keys
    assert folder is not None
    for name, court in contest.courts.items():
        if not hosts and not court.host:
            raise UserError(say("contest.where-is-court", court=name))
    try:
        kept = _set_aside(folder.path) if renew else None
        there = folder.ca.exists()
        authority = _authority(folder)
        known = [court.host for court in contest.courts.values()]
        names = list(dict.fromkeys([*_ALWAYS, *_before(folder), *filter(None, known), *hosts]))
        certificate, private_key = authority.issue(names, utc_now())
        _write(folder.private_key, private_key)
        _write(folder.certificate, certificate)
        if not folder.gateway_token.exists():
            _write(folder.gateway_token, f"{new_token()}\n".encode())
        invitations = [
            access
            for name in contest.courts
            for access in entrances.everybody(contest, name, *hosts[:1]).values()
        ]
        for access in invitations:
            text = invitation_text(access, contest.name)
            _write(folder.invitation(access.user), text.encode())
        if data != file.read_bytes():
            _write(file, data)
    except OSError as error:
        path, why = str(error.filename), error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=path, why=why)) from None
    ends = authority.ends.date().isoformat()
    return Made(folder, invitations, names, ends, there, kept)


def _with_entry(file: Path) -> tuple[bytes, Contest]:
    """Return the contest file's bytes with an entry for the key folder, and the contest in them."""
    try:
        data = file.read_bytes()
        table = read_toml(data).get("contest", {})
    except (OSError, BadToml):
        contests.load(file)  # raises an error that says what is wrong
        raise
    if "keys" not in table:
        data = _insert_entry(data, file, must_have_table=bool(table))
    return data, contests.loads(data, file)


def _insert_entry(data: bytes, file: Path, *, must_have_table: bool) -> bytes:
    folder = json.dumps(_free_folder(file), ensure_ascii=False)  # JSON strings are TOML's too
    entry = f"keys = {folder}  # folder, beside this file, of what 'lacoc contest keys' made"
    lines = data.decode("utf-8-sig").splitlines(keepends=True)
    heads = [row for row, line in enumerate(lines) if "".join(line.split()).startswith(_TABLE)]
    if must_have_table and not heads:
        wanted = f"{_TABLE[1:-1]}.keys = {folder}"
        raise UserError(say("contest.keys-write", entry=wanted, file=str(file)))
    # Without the table, append it: lines before it would belong to other tables.
    where = heads[0] + 1 if heads else len(lines)
    lines[where:where] = [f"{entry}\n"] if heads else [f"\n{_TABLE}\n{entry}\n"]
    return "".join(lines).encode()


def _free_folder(file: Path) -> str:
    """Choose a new folder for keys beside a contest file; existing ones belong to other contests.

    Raises:
        UserError: if both possible names are taken.
    """
    names = (_FOLDER, f"{_FOLDER}-{file.stem}")
    free = [name for name in names if not (file.resolve().parent / name).exists()]
    if not free:
        raise UserError(say("contest.keys-taken", folders=names, file=str(file), first=names[0]))
    return free[0]


def _authority(folder: KeyFolder) -> Authority:
    """Load the contest's authority; make a new one if there is none.

    Raises:
        UserError: if the authority that is there can't issue certificates.
    """
    if not folder.ca.exists():
        authority = Authority.new(utc_now())
        certificate, private_key = authority.pair()
        _write(folder.ca_key, private_key)
        _write(folder.ca, certificate)
        return authority
    try:
        authority = Authority.load(Pair(folder.ca.read_bytes(), folder.ca_key.read_bytes()))
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise UserError(
            say(
                "contest.keys-unusable",
                certificate=str(folder.ca),
                key=str(folder.ca_key),
                why=str(reason),
            )
        ) from None
    if authority.ends < utc_now():
        day = authority.ends.date().isoformat()
        raise UserError(say("contest.keys-ended", folder=str(folder.path), day=day))
    return authority


def _before(folder: KeyFolder) -> list[str]:
    """List the hosts in the courts' present certificate; none if there is no certificate yet.

    Raises:
        UserError: if the file is no certificate of a court.
    """
    if not folder.certificate.exists():
        return []
    try:
        return hosts_of(folder.certificate.read_bytes())
    except ValueError as error:
        why = str(error).partition(". ")[0]
        raise UserError(
            say("contest.no-certificate", path=str(folder.certificate), why=why)
        ) from None


def _set_aside(path: Path) -> Path | None:
    """Rename a folder: add the first free number to its name.

    Returns:
        The folder's new path; None if there is no such folder.
    """
    if not path.exists():
        return None
    numbered = (path.with_name(f"{path.name}.{number}") for number in itertools.count(1))
    kept = next(one for one in numbered if not one.exists())
    return path.rename(kept)


def _write(path: Path, data: bytes) -> None:
    """Write a file whole or not at all; only its owner may ever read it."""
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    new = path.with_name(f"{path.name}.new")
    new.unlink(missing_ok=True)
    with open(new, "xb", opener=lambda name, flags: os.open(name, flags, 0o600)) as file:
        file.write(data)
    new.replace(path)
