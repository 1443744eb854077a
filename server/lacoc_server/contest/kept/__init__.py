"""What a contest keeps on the disk: its file, facts, frozen entries, tokens and sheet."""
