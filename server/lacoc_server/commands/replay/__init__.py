"""`lacoc replay`: what it does with physics: verify a record, fork it, say who would have won."""
