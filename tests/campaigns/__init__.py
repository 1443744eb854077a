"""Campaigns attack and break; each is a command, `python -m tests.campaigns.kill.court` and so on.

- `forge`: makes messages, records and contests that lie. None may be believed.
- `kill`: ends processes and machines, and cuts links, at random moments. All must go on.
- `flood`: sends too much. Others must not notice.
- `fuzz`: hostile bytes and robots for all that reads them (`make fuzz`).
- `long`: plays for an hour. Nothing may grow (`make soak`).
- `mutation`: changes the code that judges. A test must notice (`make mutants`).

Short runs of them are among the tests; docs/measured.md has the figures of long ones.
"""
