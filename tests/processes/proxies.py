"""Runs the proxies of examples/online on loopback, with an authority of the test's own."""

import os
import shutil
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

import pytest
import trustme
from debian import install, locked
from waiting import LIMIT_S, until

from lacoc_shared.network.certificate import Pair

_OWN_USER = "user root;\n" if os.geteuid() == 0 else ""
"""Else nginx's workers can't reach a test's folders."""
EXAMPLES = Path(__file__).parents[2] / "examples" / "online"


def issue(folder: Path, authority: trustme.CA, *names: str, **dates: datetime) -> Pair:
    """Write a certificate for host names into a folder, in place of an older one."""
    made = authority.issue_cert(*names, **dates)
    pair = Pair(folder / "fullchain.pem", folder / "privkey.pem")
    pair.key.write_bytes(made.private_key_pem.bytes())
    pair.certificate.write_bytes(b"".join(one.bytes() for one in made.cert_chain_pems))
    return pair


@contextmanager
def caddy(folder: Path, pair: Pair, name: str, port: int, gateway: str) -> Iterator[None]:
    """Run Caddy with the example's settings before a gateway.

    Args:
        folder: an empty folder.
        pair: the certificate.
        name: host name of the pages.
        port: where Caddy listens.
        gateway: where the gateway listens, "HOST:PORT".
    """
    text = (EXAMPLES / "Caddyfile").read_text("utf-8")
    tls = f"\ttls {pair.certificate} {pair.key}\n\treverse_proxy"
    text = text.replace("\treverse_proxy", tls, 1)
    settings = "{\n\tadmin off\n\tauto_https off\n}\n"
    (folder / "Caddyfile").write_text(settings + text)
    environment = {
        "LACOC_NAME": f"https://{name}:{port}",
        "LACOC_GATEWAY": gateway,
        "LACOC_CROWD": gateway,
        "HOME": str(folder),
        "XDG_DATA_HOME": str(folder),
        "PATH": "/usr/bin:/bin",
    }
    words = ["run", "--adapter", "caddyfile", "--config", str(folder / "Caddyfile")]
    with _running(folder, [program("caddy"), *words], port, environment):
        yield


@contextmanager
def nginx(folder: Path, pair: Pair, name: str, port: int, gateway: str) -> Iterator[None]:
    """Run nginx with the example's settings before a gateway; arguments as in `caddy`."""
    text = (EXAMPLES / "nginx.conf").read_text("utf-8")
    for wanted, own in (
        ("listen 443 ssl", f"listen 127.0.0.1:{port} ssl"),
        ("server_name uni.example", f"server_name {name}"),
        ("/etc/letsencrypt/live/uni.example/fullchain.pem", str(pair.certificate)),
        ("/etc/letsencrypt/live/uni.example/privkey.pem", str(pair.key)),
        ("127.0.0.1:8080", gateway),
        ("/var/cache/nginx/lacoc", str(folder / "cache")),
    ):
        assert wanted in text
        text = text.replace(wanted, own)
    kinds = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    places = "".join(f"{kind}_temp_path {folder}/{kind};\n" for kind in kinds)
    (folder / "nginx.conf").write_text(
        f"{_OWN_USER}daemon off;\npid {folder}/nginx.pid;\nerror_log {folder}/error.log;\n"
        f"events {{}}\nhttp {{\naccess_log off;\n{places}{text}}}\n"
    )
    words = ["-p", str(folder), "-c", str(folder / "nginx.conf"), "-e", str(folder / "error.log")]
    with _running(folder, [program("nginx"), *words], port, None):
        yield


@contextmanager
def _running(
    folder: Path, command: list[str], port: int, environment: dict[str, str] | None
) -> Iterator[None]:
    with (folder / "said.log").open("wb") as log:
        process = subprocess.Popen(command, stdout=log, stderr=log, env=environment)
    try:
        until(lambda: _answers(port) or process.poll() is not None)
        assert process.poll() is None, (folder / "said.log").read_text()
        yield
    finally:
        process.terminate()
        process.wait(LIMIT_S)


def _answers(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def program(name: str) -> str:
    """Return the path of a program; install it on Debian if it is missing."""
    where = "/usr/local/sbin:/usr/sbin:/usr/local/bin:/usr/bin:/bin"
    with locked(name):
        found = shutil.which(name) or shutil.which(name, path=where)
        if found is None:
            install({"nginx": "nginx-light"}.get(name, name))
            found = shutil.which(name, path=where)
    if found is None:
        pytest.fail(f"This test needs {name}: install it (Debian: apt-get install {name}).")
    return found
