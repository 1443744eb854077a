"""Makes a contest's keys and invitations, in a folder beside its contest file."""

import itertools
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from lacoc_server.keys.certificates import Authority, Pair, hosts_of, utc_now
from lacoc_shared.contest import entrances
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.file import Contest
from lacoc_shared.contest.invitation import Access, invitation_text
from lacoc_shared.contest.key_folder import KeyFolder
from lacoc_shared.contest.tokens import new_token
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.mistakes import UserError
from lacoc_shared.network import address

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
    """Whether there were keys before, and their invitations are still valid."""
    kept: Path | None
    """Folder of the replaced keys; None: none were replaced."""


def make_keys(file: Path, hosts: Sequence[str], renew: bool) -> Made:
    """Make a contest's keys, or add what is new; write the entry into the contest file.

    The authority is made once, so invitations that were handed out stay valid. The courts'
    certificate and the invitations are written again, from what the contest file says now.

    Args:
        file: the contest file.
        hosts: names and IP addresses of the courts' machine; invitations use the first one for a
            court without an address in the file.
        renew: replace all keys, and keep the old ones under another name.

    Raises:
        UserError: if the file or the keys can't be read or written.
    """
    hosts = [address.host(address.endpoint(host)) for host in hosts]
    data, contest = _with_entry(file)
    folder = contest.keys
    assert folder is not None
    for name, court in contest.courts.items():
        if not hosts and not court.host:
            raise UserError(
                f"Where do others reach court {name!r}? Give its machine's name or number, such as "
                f"--host 192.168.1.20, or write 'connect' under [court.{name}]."
            )
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
        raise UserError(f"Cannot write {error.filename}: {error.strerror}.") from None
    ends = authority.ends.date().isoformat()
    return Made(folder, invitations, names, ends, there, kept)


def _with_entry(file: Path) -> tuple[bytes, Contest]:
    """Return the contest file with the entry that names its folder of keys, and the contest."""
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
        raise UserError(f"Write  {_TABLE[1:-1]}.keys = {folder}  into {file}, and try again.")
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
        raise UserError(
            f"{' and '.join(names)} beside {file} hold the keys of other contests, or of an older "
            f'one: rename them; or, to go on with the keys of one, write  keys = "{names[0]}"  '
            f"below [contest] in {file}."
        )
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
            f"{folder.ca} and {folder.ca_key} can't be used ({reason}). Put them back, or make "
            "all anew with --renew: then everybody needs a new invitation."
        ) from None
    if authority.ends < utc_now():
        raise UserError(
            f"The keys in {folder.path} were valid until {authority.ends.date()}. Make new ones "
            "with --renew: then everybody needs a new invitation."
        )
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
        raise UserError(
            f"{folder.certificate} is no certificate of a court ({str(error).partition('. ')[0]}). "
            "Remove it, and give each --host again: invitations stay valid. Or make all anew with "
            "--renew: then everybody needs a new invitation."
        ) from None


def _set_aside(path: Path) -> Path | None:
    """Rename a folder with the first free number; None if there is no such folder."""
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
