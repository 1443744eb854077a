"""What a contest keeps on the disk: its file, facts, entries, tokens and sheet."""
