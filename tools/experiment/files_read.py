"""The files that decide a run's numbers, found without running anything, so that `--resume` keeps no result of a file that was edited:
what a scene names, what a controller imports, the program itself.

Not found: modules that Python imports by a computed name, and files whose names a controller computes.
"""
import ast
import functools
import hashlib
import importlib.machinery
import json
import os
import tomllib

HERE = os.path.dirname(os.path.realpath(__file__))
ASSETS = os.path.normpath(os.path.join(HERE, "..", "..", "assets"))


def hash_of(path):
    """SHA-256 of its content, in hexadecimal."""
    return _hash_of(path, *_version(path))


def _version(path):
    about = os.stat(path)
    return about.st_mtime_ns, about.st_size, about.st_ino


@functools.lru_cache(maxsize=4096)
def _hash_of(path, *_):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def of_scene(path):
    """The scene and all files that it names, by `include` or any other key, and that these name; in a fixed order. A name counts
    from the folder of the file that has it."""
    return _closure(path, _named_by)


def of_module(path):
    """The module, the modules that it imports from its own folder (or PYTHONPATH) and those of theirs, and the files beside a module
    that it names in a string; in a fixed order."""
    root = os.path.dirname(os.path.abspath(path))
    return _closure(path, lambda file, *version: _used_by(file, root, *version))


def _closure(path, parts_of):
    found, waiting = [], [os.path.realpath(path)]
    while waiting:
        file = waiting.pop(0)
        if file not in found:
            found.append(file)
            waiting += parts_of(file, *_version(file))
    return found


def _strings(value):
    if isinstance(value, str):
        yield value
    elif isinstance(value, (dict, list)):
        for part in value.values() if isinstance(value, dict) else value:
            yield from _strings(part)


@functools.lru_cache(maxsize=4096)
def _named_by(path, *_):
    """Of a TOML file, or of a glTF, whose buffers and pictures may lie beside it. One that cannot be read names none: the run tells."""
    read = {".toml": tomllib.load, ".gltf": json.load}.get(os.path.splitext(path)[1].lower())
    if read is None:
        return []
    try:
        with open(path, "rb") as file:
            data = read(file)
    except (OSError, ValueError, RecursionError):
        return []
    return _files_among(_strings(data), os.path.dirname(path))


def _files_among(names, folder):
    """Those of the names that are files; what has a zero byte or is longer than a path may be is none."""
    paths = [os.path.join(folder, name) for name in names if name and len(name) < 4096 and "\0" not in name]
    return [os.path.realpath(p) for p in paths if os.path.isfile(p)]


@functools.lru_cache(maxsize=4096)
def _used_by(path, root, *_):
    if not path.endswith(".py"):
        return []
    try:
        with open(path, "rb") as file:
            tree = ast.parse(file.read())
    except (OSError, SyntaxError, ValueError, RecursionError):
        return []
    folder = os.path.dirname(path)
    roots = [root, *filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))]
    found = _files_among((n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)), folder)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for name in node.names:
                found += _module_files(name.name, roots)
        elif isinstance(node, ast.ImportFrom):
            near = [os.path.normpath(os.path.join(folder, *[".."] * (node.level - 1)))] if node.level else roots
            for name in node.names:
                found += _module_files(".".join(filter(None, (node.module, name.name))), near)
    return found


def _module_files(name, roots):
    """Of "a.b.c": the files of a, of a.b and of a.b.c, as far as they are modules below the roots."""
    found, places = [], roots
    for part in name.split("."):
        # The finder's own memory of a folder may be older than a file that was just written.
        importlib.machinery.PathFinder.invalidate_caches()
        spec = importlib.machinery.PathFinder.find_spec(part, places)
        if spec is None:
            break
        if spec.origin and os.path.isfile(spec.origin):
            found.append(os.path.realpath(spec.origin))
        places = list(spec.submodule_search_locations or [])
    return found


def of_program(program):
    """A hash of what runs: the program, its Python package, these tools, and the assets that it is shipped with but for scenarios,
    whose own files are looked at apart."""
    package = os.path.normpath(os.path.join(os.path.dirname(os.path.realpath(program)), "..", "python"))
    files = [program, *_below(package, (".py", ".so")), *_below(HERE, (".py",)), *_below(ASSETS, (), leave_out="experiments")]
    whole = hashlib.sha256()
    for file in files:
        if os.path.isfile(file):
            whole.update(os.path.basename(file).encode() + bytes.fromhex(hash_of(file)))
    return whole.hexdigest()[:16]


def _below(folder, ends, leave_out=None):
    found = []
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(f for f in folders if f not in (leave_out, "__pycache__"))
        found += [os.path.join(place, n) for n in sorted(names) if not ends or n.endswith(ends)]
    return found
