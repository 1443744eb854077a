"""Films of recorded matches: the pages' own pictures, drawn one by one, as an MP4."""
