"""Make and check the TLS certificate of a contest's pages and courts, also without a domain."""

import ipaddress
import json
from collections.abc import Iterator, Sequence
from datetime import UTC, date, datetime, timedelta
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.hashes import SHA256
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    load_pem_private_key,
)
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from lacoc_shared.command.replacing import write
from lacoc_shared.contest import file as contests
from lacoc_shared.contest.file import ContestFile
from lacoc_shared.contest.toml_text import BadToml, read_toml
from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.network import address
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import Phrase, say

_FOLDER = "tls"
_AUTHORITY, _AUTHORITY_KEY, _CHAIN, _KEY = (
    f"{_FOLDER}/{name}"
    for name in ("authority.pem", "authority.key", "fullchain.pem", "privkey.pem")
)
_ENTRIES = {"certificate": _CHAIN, "private_key": _KEY, "authority": _AUTHORITY}
_TABLE = "[contest]"
_ALWAYS = ("localhost", "127.0.0.1", "::1")
_NAME = "LACOC contest"
_LIFE = timedelta(days=397)
"""How long a certificate is valid."""
_AUTHORITY_LIFE = timedelta(days=3650)
_CLOCKS_DIFFER = timedelta(days=1)
_SOON = timedelta(days=14)


def make_certificate(file: Path, hosts: Sequence[str]) -> tuple[list[str], date]:
    """Make a TLS certificate, and write the paths of its files into the contest file.

    The first run also makes the private authority that issues the certificate. A later run makes a
    new certificate, which keeps all names of the previous one.

    Args:
        file: the contest file.
        hosts: names and IP addresses to add to those of the contest file and of this machine.

    Returns:
        All names and IP addresses in the certificate, and its last day.

    Raises:
        UserError: if a file can't be used or written, or if the contest file names a certificate
            that was not made here.
    """
    hosts = [address.host(address.endpoint(host)) for host in hosts]
    data, contest = _with_entries(file)
    folder, now = file.resolve().parent, datetime.now(UTC)
    chain = folder / _CHAIN
    courts = contest.courts.values()
    known = [*(court.host for court in courts), contest.public.host, address.own_address()]
    known += [address.host(court.elsewhere) for court in courts if court.elsewhere]
    before = _names(_read(chain)) if chain.exists() else []
    names = list(dict.fromkeys([*_ALWAYS, *before, *filter(None, known), *hosts]))
    try:
        authority, authority_key = _authority(folder, now)
        key = ec.generate_private_key(ec.SECP256R1())
        end = min(now + _LIFE, authority.not_valid_after_utc)
        issuer = authority_key.public_key()
        certificate = (
            _builder(f"{_NAME} certificate", authority.subject, key, now, end)
            .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
            .add_extension(_usage(digital_signature=True), critical=True)
            .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
            .add_extension(
                x509.SubjectAlternativeName(list(map(_general_name, names))), critical=False
            )
            .add_extension(
                x509.AuthorityKeyIdentifier.from_issuer_public_key(issuer), critical=False
            )
            .sign(authority_key, SHA256())
        )
        _write(folder / _KEY, _pem(key))
        _write(chain, _pem(certificate) + _pem(authority))
        if data != file.read_bytes():
            _write(file, data)
    except OSError as error:
        path, why = str(error.filename), error.strerror or str(error)
        raise UserError(say("command.cannot-write", path=path, why=why)) from None
    return names, end.date()


def _with_entries(file: Path) -> tuple[bytes, ContestFile]:
    """Return the contest file with the lines that name the certificate's files; write nothing.

    Returns:
        The file as bytes, and the same as a `ContestFile`.

    Raises:
        UserError: if the file can't be read or has a mistake, or if it names other files than those
            that `make_certificate` writes.
    """
    try:
        data = file.read_bytes()
        table = read_toml(data).get("contest", {})
    except (OSError, BadToml):
        contests.load(file)  # raises an error that says what is wrong
        raise
    given = {name: table[name] for name in _ENTRIES if name in table}
    if not given:
        data = _insert_entries(data, file, must_have_table=bool(table))
    elif given != _ENTRIES:
        raise UserError(say("contest.other-certificate", file=str(file), entries=[*given]))
    return data, contests.loads(data, file)


def _insert_entries(data: bytes, file: Path, *, must_have_table: bool) -> bytes:
    entries = [f"{name} = {json.dumps(path)}\n" for name, path in _ENTRIES.items()]
    lines = data.decode("utf-8-sig").splitlines(keepends=True)
    heads = [row for row, line in enumerate(lines) if "".join(line.split()).startswith(_TABLE)]
    if must_have_table and not heads:
        raise UserError(say("contest.certificate-table", file=str(file)))
    # Without the table, append it: lines before it would belong to other tables.
    where = heads[0] + 1 if heads else len(lines)
    lines[where:where] = entries if heads else [f"\n{_TABLE}\n", *entries]
    return "".join(lines).encode()


def _authority(folder: Path, now: datetime) -> tuple[x509.Certificate, ec.EllipticCurvePrivateKey]:
    """Load the certificate authority of a folder; if the folder has none, make one.

    Raises:
        UserError: if the folder has an authority, but it can't issue certificates.
    """
    file, key_file = folder / _AUTHORITY, folder / _AUTHORITY_KEY
    if not file.exists() and not key_file.exists():
        key = ec.generate_private_key(ec.SECP256R1())
        name = f"{_NAME} authority"
        certificate = (
            _builder(name, _x509_name(name), key, now, now + _AUTHORITY_LIFE)
            .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
            .add_extension(_usage(key_cert_sign=True), critical=True)
            .sign(key, SHA256())
        )
        _write(key_file, _pem(key))
        _write(file, _pem(certificate))
        return certificate, key
    try:
        found, loaded = _read(file), load_pem_private_key(key_file.read_bytes(), None)
        if not isinstance(loaded, ec.EllipticCurvePrivateKey):
            raise ValueError("its key is of another kind")
        if found.public_key() != loaded.public_key():
            raise ValueError("certificate and key do not belong together")
        if found.not_valid_after_utc < now:
            raise ValueError("it has ended")
    except (OSError, ValueError, TypeError) as error:  # TypeError: the key has a password
        why = (error.strerror if isinstance(error, OSError) else None) or str(error)
        files = [str(file), str(key_file)]
        raise UserError(say("contest.authority-unusable", files=files, why=why)) from None
    return found, loaded


def _builder(
    name: str, issuer: x509.Name, key: ec.EllipticCurvePrivateKey, now: datetime, end: datetime
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(_x509_name(name))
        .issuer_name(issuer)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - _CLOCKS_DIFFER)
        .not_valid_after(end)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
    )


def _x509_name(text: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, text)])


def _general_name(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        return x509.DNSName(host)


def _usage(*, key_cert_sign: bool = False, digital_signature: bool = False) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=digital_signature,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=key_cert_sign,
        crl_sign=key_cert_sign,
        encipher_only=False,
        decipher_only=False,
    )


def _pem(one: x509.Certificate | ec.EllipticCurvePrivateKey) -> bytes:
    if isinstance(one, x509.Certificate):
        return one.public_bytes(Encoding.PEM)
    return one.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())


def _write(path: Path, data: bytes) -> None:
    path.parent.mkdir(mode=0o700, exist_ok=True)
    write(path, data, secret=True)


def doubts(
    public: PublicAddress, entries_close: datetime | None, now: datetime
) -> Iterator[Phrase]:
    """Yield warnings about a contest's certificate: it ends soon, or lacks the host of the pages.

    Args:
        public: address of the pages, with the path of their certificate (not None).
        entries_close: when entries close, if the contest file says so. The contest is later, so the
            certificate must outlast this time.
        now: time with a time zone.

    Raises:
        UserError: if the certificate can't be read.
    """
    assert public.certificate is not None
    found = _read(public.certificate)
    end = found.not_valid_after_utc
    begins = now if entries_close is None else max(now, entries_close.astimezone(UTC))
    if end - _SOON < begins:
        yield say("contest.certificate-ends", day=str(end.date()))
    names = _names(found)
    if public.host and not any(_is_of(name, public.host) for name in names):
        yield say("contest.certificate-name", host=public.host, names=names)


def _read(file: Path) -> x509.Certificate:
    try:
        return x509.load_pem_x509_certificates(file.read_bytes())[0]
    except OSError as error:
        why = say("public.unreadable", why=error.strerror or str(error))
    except ValueError as error:
        why = say("public.no-pair", why=str(error))
    raise UserError(say("public.wrong-certificate", files=[text_of(file)], why=why))


def _names(certificate: x509.Certificate) -> list[str]:
    try:
        found = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return []
    addresses = map(str, found.get_values_for_type(x509.IPAddress))
    return [*found.get_values_for_type(x509.DNSName), *addresses]


def _is_of(name: str, host: str) -> bool:
    """Return whether a name in a certificate covers a host.

    It does if it is the host's own name, or "*." followed by the host's domain.
    """
    name = name.lower()
    return name == host or (name.startswith("*.") and name[2:] == host.partition(".")[2])
