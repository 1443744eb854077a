"""The services in docker/ work together: each command runs here as a process, without Docker."""

import json
import os
import queue
import re
import subprocess
import sys
import threading
import time
import tomllib
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
import yaml
from lacoc_process import Lacoc, run_lacoc
from ports import free_port
from waiting import LIMIT_S, until

from lacoc_shared.contest import file as contests

ROOT = Path(__file__).parents[2]
COMPOSE = yaml.safe_load((ROOT / "docker" / "compose.yaml").read_text(encoding="utf-8"))
SERVICES: dict[str, dict[str, Any]] = COMPOSE["services"]
DOCKERFILE = (ROOT / "docker" / "Dockerfile").read_text(encoding="utf-8")
PORT, WEB_PORT = "7447", "8080"


def order() -> list[str]:
    """Return the services' names, each after the services it depends on."""
    ordered: list[str] = []
    while len(ordered) < len(SERVICES):
        ready = [
            name
            for name, service in SERVICES.items()
            if name not in ordered and set(service.get("depends_on", ())) <= set(ordered)
        ]
        assert ready, "the services depend on each other in a circle"
        ordered += ready
    return ordered


def test_the_image_installs_what_a_court_needs() -> None:
    """The image starts `lacoc`, with an extra and a Python version that the project supports."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

    assert 'ENTRYPOINT ["lacoc"]' in DOCKERFILE
    assert set(re.findall(r"\[(\w+)\]\"", DOCKERFILE)) <= set(project["optional-dependencies"])
    assert project["requires-python"] == ">=3.11"
    assert set(re.findall(r"FROM (\S+)", DOCKERFILE)) == {"python:3.11-slim"}


def test_the_services_hang_together() -> None:
    """All services use one image, and the last one opens court and pages."""
    assert {service["image"] for service in SERVICES.values()} == {"lacoc"}
    office = SERVICES["office"]
    assert office["ports"] == [f"{PORT}:{PORT}", f"{WEB_PORT}:{WEB_PORT}"]
    assert office["command"][-1].endswith(f":{WEB_PORT}")
    assert (ROOT / "docker" / office["build"]["context"]).resolve() == ROOT
    assert order() == ["contest", "ants", "bees", "office"]


@pytest.mark.slow
@pytest.mark.long
def test_the_composition_plays(tmp_path: Path) -> None:
    """When the services start in their order, the two bots are called to the court, and play."""
    port, web_port = str(free_port()), str(free_port())

    def here(text: str) -> str:
        """Replace a container's folders, hosts and ports with those of this machine."""
        text = text.replace("/contest/", f"{tmp_path}/")
        return text.replace(PORT, port).replace(WEB_PORT, web_port)

    with ExitStack() as running:
        lines: queue.Queue[str] = queue.Queue()
        for name in order():
            service = SERVICES[name]
            environment = {key: here(value) for key, value in service["environment"].items()}
            command = [here(word) for word in service["command"]]
            process = running.enter_context(lacoc(command, environment, lines, tmp_path))
            conditions = {
                other["depends_on"][name]["condition"]
                for other in SERVICES.values()
                if name in other.get("depends_on", ())
            }
            if "service_completed_successfully" in conditions:
                assert process.wait(LIMIT_S) == 0
                file = tmp_path / "contest.toml"
                file.write_text(here(file.read_text()))
        wait_until_healthy([here(word) for word in SERVICES["office"]["healthcheck"]["test"]])
        heard = wait_for(lines, "The contest is open", timeout_s=60)
        with urllib.request.urlopen(
            f"http://127.0.0.1:{web_port}/contest", timeout=LIMIT_S
        ) as page:
            assert b"LACOC" in page.read()
        until(lambda: [*(tmp_path / "recordings").glob("*.live.mcap")])
    assert any("Bees" in line for line in heard)


def test_the_contest_online_is_the_one_of_its_page(tmp_path: Path) -> None:
    """The commands of docs/online.md write contest files that fit the proxies in front of them."""
    online = yaml.safe_load((ROOT / "docker" / "online.yaml").read_text(encoding="utf-8"))
    contest, caddy = online["services"]["contest"], online["services"]["caddy"]
    assert caddy["environment"]["LACOC_GATEWAY"] == "contest:8080"
    assert contest["command"][-1].endswith(":8080")
    mounted = caddy["volumes"][0].partition(":")[0]
    assert (ROOT / "docker" / mounted).resolve() == ROOT / "examples" / "online" / "Caddyfile"
    unit = (ROOT / "examples" / "online" / "lacoc.service").read_text(encoding="utf-8")
    assert "--listen 127.0.0.1:8080" in unit
    page = (ROOT / "docs" / "online.md").read_text(encoding="utf-8")
    lines = re.findall(r"contest init (contest\.toml .*--pages .*)", page)
    proxies = []
    for line in lines:
        words = line.replace("$LACOC_NAME", "lacoc.example.org").split()
        assert run_lacoc("contest", "init", *words, cwd=tmp_path).returncode == 0
        made = contests.load(tmp_path / "contest.toml")
        assert made.public.pages == "https://lacoc.example.org"
        assert {one.listen[0].partition(":")[0] for one in made.courts.values()} == {
            "tcp/127.0.0.1"
        }
        proxies.append(made.public.proxies)
    assert proxies == [("172.16.0.0/12",), ("127.0.0.1",)]


@contextmanager
def lacoc(
    command: list[str], environment: dict[str, str], lines: "queue.Queue[str]", folder: Path
) -> Iterator[Lacoc]:
    """Run a subcommand and put its output lines into a queue."""
    clean = {key: value for key, value in os.environ.items() if not key.startswith("LACOC_")}
    with Lacoc(
        *command,
        env={**clean, **environment},
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ) as process:
        assert process.stdout is not None
        reader = threading.Thread(target=lambda out: [*map(lines.put, out)], args=[process.stdout])
        reader.start()
        try:
            yield process
        finally:
            process.terminate()
            try:
                process.wait(LIMIT_S)
            except subprocess.TimeoutExpired:
                process.kill()
            reader.join()


def wait_until_healthy(check: list[str], timeout_s: float = 60) -> None:
    """Repeat a service's health check until it succeeds."""
    assert check[:2] == ["CMD", "python"]
    until_s = time.monotonic() + timeout_s
    while subprocess.run([sys.executable, *check[2:]], capture_output=True, check=False).returncode:
        assert time.monotonic() < until_s, "the court did not become healthy"


def wait_for(lines: "queue.Queue[str]", word: str, timeout_s: float) -> list[str]:
    """Return all output lines up to the first one that contains a word."""
    heard: list[str] = []
    until_s = time.monotonic() + timeout_s
    while not heard or word not in heard[-1]:
        try:
            heard.append(lines.get(timeout=max(0.0, until_s - time.monotonic())))
        except queue.Empty:
            pytest.fail(f"{word!r} was not said, but:\n{json.dumps(heard, indent=1)}")
    return heard
