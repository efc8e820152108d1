"""In place of matplotlib, for tests of data whose picture nobody looks at, and of a machine without it."""
raise ModuleNotFoundError("none here", name="matplotlib")
