"""Finds the certificate and the users of a court in a contest with keys."""

from lacoc_shared.contest import entrances
from lacoc_shared.contest.file import Contest
from lacoc_shared.network.access_rules import Protection


def protection(contest: Contest, court: str) -> Protection | None:
    """Find a court's certificate and its users; None in a contest without keys.

    Raises:
        UserError: if the keys can't be read.
    """
    keys = contest.keys
    if keys is None:
        return None
    for path in (keys.certificate, keys.private_key):
        keys.read(path)  # its error says what to do; Zenoh's error does not
    everybody = entrances.everybody(contest, court)
    credentials = [access.credentials for access in everybody.values()]
    return Protection(
        court=court,
        certificate=keys.certificate,
        private_key=keys.private_key,
        passwords={one.user: one.password for one in credentials if one is not None},
        seats={name: access.user for name, access in everybody.items() if access.role == "seat"},
        referee=everybody["referee"].user,
    )
