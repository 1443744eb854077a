"""The checks of `lacoc doctor`."""
