"""Films of recorded matches: pictures of the replay's page, drawn one by one, as an MP4."""
