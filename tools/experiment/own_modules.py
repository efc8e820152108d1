"""The modules that a controller or a player imports, apart from those of every other file and run: each file's imports are made
anew for each run, so that no run sees what another left in a module, and two files with a helper of the same name have each their own.

While its code runs, sys.modules and sys.path are its own: its folder comes first, and the modules of this tool are not there. What
Python or a package installed is shared, as are modules in machine code, which cannot be imported twice.
"""
import contextlib
import functools
import importlib.util
import os
import sys
import sysconfig

HERE = os.path.dirname(os.path.realpath(__file__))
TOOLS = (HERE, os.path.normpath(os.path.join(HERE, "..", "plot")))
TOOL_NAMES = {n.removesuffix(".py") for folder in TOOLS if os.path.isdir(folder) for n in os.listdir(folder) if n.endswith(".py")}
INSTALLED = tuple({os.path.realpath(sysconfig.get_path(p)) for p in ("stdlib", "platstdlib", "purelib", "platlib")})
PACKAGES = ("site-packages", "dist-packages")
# Names that mean the same in every file, also where a file beside it has one.
COMMON = frozenset((*sys.stdlib_module_names, "numpy", "neritic"))


class OwnModules:
    """Of the files of one folder in one run. One thread uses it."""

    def __init__(self, folder):
        self._folder, self._modules, self._is_here = folder, {}, False

    def load(self, path, name):
        """Runs the file as a module of this name, and returns it."""
        spec = importlib.util.spec_from_file_location(name, path)
        module = importlib.util.module_from_spec(spec)
        self._modules[name] = module  # as for each import: what its classes say of their module is true
        with self.here():
            spec.loader.exec_module(module)
        return module

    @contextlib.contextmanager
    def here(self):
        """While code of these files runs; also within itself."""
        if self._is_here:
            yield
            return
        self._is_here = True
        paths = list(sys.path)
        sys.path[:] = [self._folder, *(p for p in paths if not _is_tools(p))]
        hidden = {n: sys.modules.pop(n) for n in TOOL_NAMES & sys.modules.keys() if _is_of_tools(getattr(sys.modules[n], "__file__", None))}
        covered = {n: sys.modules[n] for n in self._modules if n in sys.modules}
        shared = sys.modules.keys() - covered.keys()
        sys.modules.update(self._modules)
        try:
            yield
        finally:
            self._is_here, new = False, sys.modules.keys() - shared
            self._modules = {n: sys.modules[n] for n in new if n in self._modules or _is_own(n, sys.modules[n])}
            for name in self._modules:
                del sys.modules[name]
            sys.modules.update(covered)
            sys.modules.update(hidden)
            sys.path[:] = paths


@functools.lru_cache(maxsize=1024)
def _is_tools(folder):
    return bool(folder) and os.path.realpath(folder) in TOOLS


@functools.lru_cache(maxsize=1024)
def _is_of_tools(file):
    return isinstance(file, str) and _is_tools(os.path.dirname(file))


def _is_own(name, module):
    if name.partition(".")[0] in COMMON:
        return False
    file = getattr(module, "__file__", None)
    if not isinstance(file, str):  # of a folder without __init__.py that is a package, and of what no file has
        places = list(getattr(module, "__path__", []))
        file = os.path.join(places[0], "__init__.py") if places else ""
    if not file.endswith((".py", ".pyc")):
        return False
    file = os.path.realpath(file)
    return not any(p in PACKAGES for p in file.split(os.sep)) and not file.startswith(tuple(p + os.sep for p in INSTALLED))
