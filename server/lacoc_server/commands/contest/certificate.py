"""What is doubtful about the certificate of a contest's pages."""

from collections.abc import Iterator
from datetime import datetime, timedelta

from cryptography import x509

from lacoc_shared.mistakes import UserError, text_of
from lacoc_shared.network.public import PublicAddress
from lacoc_shared.words import Phrase, say

_SOON = timedelta(days=14)


def doubts(
    public: PublicAddress, entries_close: datetime | None, now: datetime
) -> Iterator[Phrase]:
    """Yield what is doubtful about a certificate: it ends soon, or is of another name.

    Args:
        public: how others reach the pages; it has a certificate.
        entries_close: when entries close, if the contest file says so: the contest is later.
        now: time with a time zone.

    Raises:
        UserError: if the certificate can't be read.
    """
    assert public.certificate is not None
    try:
        found = x509.load_pem_x509_certificates(public.certificate.read_bytes())[0]
    except OSError as error:
        why = say("public.unreadable", why=error.strerror or str(error))
        raise _wrong(public, why) from None
    except ValueError as error:
        raise _wrong(public, say("public.no-pair", why=str(error))) from None
    end = found.not_valid_after_utc
    begins = now if entries_close is None else max(now, entries_close.astimezone())
    if end < begins + _SOON:
        yield say("contest.certificate-ends", day=str(end.date()))
    names = _names(found)
    if public.host and not any(_is_of(name, public.host) for name in names):
        yield say("contest.certificate-name", host=public.host, names=names)


def _wrong(public: PublicAddress, why: Phrase) -> UserError:
    files = [text_of(file) for file in (public.certificate, public.private_key) if file]
    return UserError(say("public.wrong-certificate", files=files, why=why))


def _names(certificate: x509.Certificate) -> list[str]:
    try:
        found = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return []
    addresses = map(str, found.get_values_for_type(x509.IPAddress))
    return [*found.get_values_for_type(x509.DNSName), *addresses]


def _is_of(name: str, host: str) -> bool:
    """Return whether a name of a certificate is a host, or "*." before its domain."""
    name = name.lower()
    return name == host or (name.startswith("*.") and name[2:] == host.partition(".")[2])
