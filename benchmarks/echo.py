"""A bare Zenoh echo in a process of its own: the baseline of `benchmarks.latency`.

It uses Zenoh as it comes, without the project's session: no access rules, one callback.
"""

import sys

import zenoh

PING, PONG = "lacoc/echo/ping", "lacoc/echo/pong"

_ANSWER = bytes(280)  # as long as a frame
_CONFIG = """{
  mode: "router",
  listen: { endpoints: ["tcp/127.0.0.1:0"] },
  scouting: { multicast: { enabled: false }, gossip: { enabled: false } },
  adminspace: { enabled: true },
  transport: { shared_memory: { enabled: false } },
}"""


def main() -> None:
    """Answer every ping until the input ends."""
    with zenoh.open(zenoh.Config.from_json5(_CONFIG)) as session:
        pong = session.declare_publisher(PONG)

        def answer(_: zenoh.Sample) -> None:
            pong.put(_ANSWER)

        session.declare_subscriber(PING, zenoh.handlers.Callback(answer, indirect=False))
        for reply in session.get(f"@/{session.info.zid()}/router"):
            if reply.ok is not None:
                print(reply.ok.payload.to_string(), flush=True)
        sys.stdin.read()


if __name__ == "__main__":
    main()
