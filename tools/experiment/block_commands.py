"""Commands of the program that a study's block may run, and their flags: a block writes into its participant's folder alone, which a
withdrawal erases. A flag that is not here is refused, since nobody has said whether it writes.

Not here: `keys`, whose folder has no flag, and `study`, which writes into another study's folder.
"""
import os
import re

from scenario import Refused

# command: (flags whose value is a file or folder that it writes, its other flags); as tools/neritic/command_line has them.
COMMANDS = {
    "render": ("out log dump-graph",
               "frames size time clip sensor only compress water replay scene add offset device chart-cell quality picture-quality "
               "track-only own-rates log-rate seed runs sheet validate"),
    "sonar": ("out",
              "depth normals labels intrinsics pixel-centers depth-kind depth-scale baseline axes camera-pose normals-sign gamma sensor quality "
              "range azimuth elevation bins method gather side backscatter-db seed picture altitude incidence device validate no-pictures "
              "overwrite workers"),
    "dive": ("log plot record save timeline screenshot",
             "headless display bindings refresh log-rate record-images play replay scene add water restore seed runs serve keys markers "
             "realtime json fast panels hud diver units quality seconds frames size sensor view swim operator task device validate"),
    "serve": ("record recordings", "bind keys realtime lockstep clients seconds seed no-shared-memory device validate"),
    "tradeoff": ("out", "scene kind recordings device quick"),
    "check": ("", "integrator hz json"),
    "plan": ("plot out",
             "gas travel depth time level after gf convention table altitude surface water last-stop ascent-rate descent-rate saturation "
             "rmv sac minimum-gas tank log vehicle depths-up json"),
    "physio": ("out plot",
               "channel rate annotations estimator window reference realtime method headset intrinsics table json"),
    "register": ("", "headset lab-up tilted json"),
    "experiment": ("out", "runs seed set workers resume json"),
    "recording": ("out", "format topic json"),
    "hud": ("", "key server-key hud diver units frames validate replay connect"),
    "simulate": ("record log",
                 "scene to seconds delay-ms jitter-ms loss repeat cut corrupt garbage seed limbs buttons ecg sound suit-hz no-gloves rate "
                 "picture-hz size device json"),
    "doctor": ("", "device json"),
}
OF_ALL = {"help", "quiet", "verbose", "version"}


def check(where, words):
    """Refuses what a block may not run: another command, an unknown flag, a file outside of the participant's folder."""
    if not words:
        return
    name = next((w for w in words if not w.startswith("-")), None)
    if name not in COMMANDS:
        raise Refused(f"{where}: found {name or words!r}; accepted, as the first word: {', '.join(COMMANDS)}")
    writes, others = (set(flags.split()) for flags in COMMANDS[name])
    for i, word in enumerate(words):
        if not word.startswith("--") or word == "--":
            # What a single hyphen begins is a number, or letters of flags of all commands.
            if re.match(r"-[^0-9.,]", word) and not re.fullmatch(r"-([hqv]+|-)", word):
                raise Refused(f"{where}: found {word}; accepted: -q, -v, and flags of {name} that begin with --")
            continue
        flag, mark, value = word[2:].partition("=")
        if flag in writes:
            value = value if mark else "".join(words[i + 1:i + 2])
            if not _is_own(value):
                raise Refused(f"{where}: found --{flag} {value}; accepted: --{flag} {{record}}... or {{folder}}/..., the participant's own")
        elif flag not in others | OF_ALL:
            raise Refused(f"{where}: found --{flag}; accepted, of {name}: {', '.join('--' + f for f in sorted(writes | others))}")


def value_of(words, flag):
    """The value of --flag in a command's words, or None."""
    for i, word in enumerate(words):
        name, mark, value = word.partition("=")
        if name == f"--{flag}":
            return value if mark else "".join(words[i + 1:i + 2])
    return None


def results_of(words, shipped):
    """The files results.json that an `experiment` of these words writes, each once all of its runs are made; none of another command.
    shipped: the scenarios of `experiment all`."""
    plain = [w for w in words if not w.startswith("-")]
    out = value_of(words, "out")
    if plain[:1] != ["experiment"] or not out:
        return []
    return [os.path.join(out, *folder, "results.json") for folder in ([[name] for name in shipped] if "all" in plain[1:2] else [[]])]


def _is_own(path):
    """Whether it lies in the participant's folder: {record} is the beginning of a file's name there."""
    match = re.fullmatch(r"\{record\}(?P<rest>.*)|\{folder\}(?P<below>/.*)?", path, re.DOTALL)
    rest = match and (match["rest"] or match["below"] or "")
    return match is not None and ".." not in rest.split("/") and "{record}" not in rest and "{folder}" not in rest
