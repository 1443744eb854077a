"""Where a stream is written: a file, a folder or a video server, and in which format."""

import re
from dataclasses import dataclass, field
from pathlib import Path

from lacoc_shared.command import keep
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

_SILENT_US = "10000000"
"""FFmpeg gives up a connection over which nothing passes for this long [us]; RTMP has no such
option."""
_LIST = "index.m3u8"
_FLAGS = "delete_segments+append_list"
"""A stream that is started again goes on with the list and its numbers, for players that are open.
"""
_FORMATS = {
    ".mp4": ("mp4", {"movflags": "frag_keyframe+empty_moov+default_base_moof"}),
    ".mkv": ("matroska", {}),
    ".ts": ("mpegts", {}),
}
_SERVERS = {"rtmp": "flv", "rtmps": "flv", "srt": "mpegts", "tcp": "mpegts", "udp": "mpegts"}


@dataclass(frozen=True)
class Target:
    """Where a live stream goes: a file, a folder or a video server.

    Args:
        address: a path, or an address of a video server.
        form: the format of the container, by FFmpeg's name.
        options: options of the container.
    """

    address: str
    form: str
    options: dict[str, str] = field(default_factory=dict)
    is_remote: bool = False
    """Whether the target is a server, which may come back after it was gone."""

    @property
    def shown(self) -> str:
        """The address as messages show it; of a server only its kind and name."""
        return _without_key(self.address) if self.is_remote else self.address


def target(wanted: str) -> Target:
    """Return the target that a user named for a live stream.

    An older recording in a file of this name is kept under a numbered name; an older .m3u8, which
    lists the last seconds only, is continued.

    Args:
        wanted: an address that begins with rtmp://, rtmps://, srt://, tcp:// or udp://; a folder,
            which gets the files of an HLS stream and is made; or a file that ends in .m3u8, .mp4,
            .mkv or .ts.

    Raises:
        UserError: if it is none of these, or the folder of the file does not exist.
    """
    scheme, is_address, _ = wanted.partition("://")
    if is_address:
        if scheme not in _SERVERS:
            raise UserError(say("stream.bad-target", target=_without_key(wanted)))
        options = {} if scheme in ("rtmp", "rtmps") else {"rw_timeout": _SILENT_US}
        return Target(wanted, _SERVERS[scheme], options, is_remote=True)
    path = Path(wanted)
    is_new = not path.suffix and path.parent.is_dir()  # else the address lacks its beginning
    if path.is_dir() or is_new or wanted.endswith("/"):
        keep.make_folder(path)
        path /= _LIST
    if not path.parent.is_dir():
        raise UserError(say("film.no-folder", folder=str(path.parent)))
    if path.suffix == ".m3u8":
        options = {"hls_time": "2", "hls_list_size": "8", "hls_flags": _FLAGS}
        return Target(str(path), "hls", options)
    if path.suffix not in _FORMATS:
        raise UserError(say("stream.bad-target", target=wanted))
    form, options = _FORMATS[path.suffix]
    keep.make_room(path)
    return Target(str(path), form, options)


def _without_key(address: str) -> str:
    """Leave out of a server's address what may be secret: user, password, and all after the host.

    Platforms have the stream's key in the path, in the query, or in both.
    """
    scheme, _, rest = address.partition("://")
    host = re.split(r"[/?#]", rest, maxsplit=1)[0].rpartition("@")[2]
    return f"{scheme}://{host}/..."
