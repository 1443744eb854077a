"""The parts of `lacoc replay` that need physics: verify, fork, odds and highlights of a record."""
