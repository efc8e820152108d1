"""The errors that neritic raises: one line each, "WHERE: found X; accepted: Y"."""


class Error(RuntimeError):
    """Something from outside failed: a device, a disk, a network."""


class BadInput(Error, ValueError):
    """An argument, a file or a scene is wrong; the line says what is accepted."""
