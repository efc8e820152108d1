"""What made results, so that they can be cited and made again: the version, the commit of these tools, and a hash of the program, its
Python package, its assets and these tools."""
import functools
import os
import subprocess

import files_read
from runner import Tools

HERE = os.path.dirname(os.path.realpath(__file__))


@functools.lru_cache(maxsize=4)
def of(program):
    """{version, commit, changed, program}: commit is None where the tools lie in no git repository, changed whether files that git knows
    differ from it. Failed where the program tells no version."""
    own = _git("ls-files", "--error-unmatch", os.path.basename(__file__)) is not None  # and not somebody's repository about an installed copy
    commit = _git("rev-parse", "--short=12", "HEAD") if own else None
    return {"version": Tools(program, "").neritic("--version").strip(), "commit": commit,
            "changed": None if commit is None else bool(_git("status", "--porcelain", "--untracked-files=no")),
            "program": files_read.of_program(program)}


def _git(*words):
    try:
        done = subprocess.run(["git", "-C", HERE, *words], capture_output=True, text=True)
    except OSError:
        return None  # no git here
    return done.stdout.strip() if done.returncode == 0 else None
