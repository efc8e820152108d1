"""Error over cost of the vectorised environments' step: `python3 -m neritic.tradeoff [--out DIR]`.

The reference is the method of the simulation ("guarded") in steps of a sixteenth. Every method flies the
same random thrusts from the same starts for 10 s without noise; the error is of the place at the end."""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from typing import Optional

import numpy as np

from .vector import _vehicle_file, vector
from .world import open as open_world

METHODS = (("split", 1), ("split", 2), ("split", 3), ("split", 4), ("split", 8), ("guarded", 1), ("guarded", 4))


def fly(method: str, substeps: int, envs: int = 256, seconds: float = 10.0) -> tuple[np.ndarray, float]:
    """The places at the end, and the processor time of an environment's step in microseconds."""
    env = vector("hover", envs, method=method, substeps=substeps, randomise={
        "position_noise_m": 0, "velocity_noise_m_s": 0, "angle_noise_rad": 0, "rate_noise_rad_s": 0},
        max_steps=2**31 - 1)
    env.reset(seed=1)
    random = np.random.default_rng(1)
    thrust = np.zeros((envs, 8), np.float32)
    steps, spent = round(seconds / env.step_s), 0.0
    for step in range(steps):
        if step % 10 == 0:
            thrust = random.uniform(-0.3, 0.3, (envs, 8)).astype(np.float32)
        begun = time.process_time()
        env.step(thrust)
        spent += time.process_time() - begun
    return env.truth()[:, :3], 1e6 * spent / (envs * steps)


def error_against_scene(substeps: int, seconds: float = 4.0, method: str = "split") -> float:
    """Metres by which an environment's vehicle and a scene's are apart after the same thrusts."""
    env = vector("hover", 1, randomise=False, method=method, substeps=substeps, max_steps=2**31 - 1)
    env.reset(seed=4)
    east, north, up, qx, qy, qz, qw = env.truth()[0, :7]
    yaw = 2.0 * np.arctan2(qz, qw)
    turn = yaw - np.pi / 2  # a scene's vehicle without rotation faces north
    vehicle = _vehicle_file()
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "open_water.toml"
        # 250 steps a second: ten are a step of the environment.
        scene.write_text(
            f'[physics]\nrate_hz = 250\n[[vehicles]]\nname = "rov"\nshape = "box"\ndynamics = "{vehicle}"\n'
            f"position_m = [{east}, {up}, {-north}]\n"
            f"rotation_xyzw = [0, {np.sin(turn / 2)}, 0, {np.cos(turn / 2)}]\n")
        run = open_world(scene, seed=1)
    rov, random = run["rov"], np.random.default_rng(1)
    for step in range(round(seconds / env.step_s)):
        if step % 10 == 0:
            share = random.uniform(-0.3, 0.3, (1, 8)).astype(np.float32)
            # As the environment: shares of each thruster's force either way.
            force = np.where(share[0] < 0, -rov.thruster_n[:, 0], rov.thruster_n[:, 1]) * share[0]
        rov.thrusters(force)
        run.tick(round(env.step_s / run.step_s))
        env.step(share)
    return float(np.linalg.norm(run.truth("rov").position - env.truth()[0, :3]))


def main(arguments: Optional[list[str]] = None) -> None:
    """Prints the table; with --out DIR draws it."""
    parser = argparse.ArgumentParser(prog="python3 -m neritic.tradeoff", description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, help="folder for tradeoff_envs.png and .csv")
    options = parser.parse_args(arguments)
    reference, _ = fly("guarded", 16)
    rows = []
    print(f"{'method':<12}{'us a step':>12}{'k steps/s a core':>18}{'median error mm':>18}{'worst mm':>12}")
    for method, substeps in METHODS:
        places, cost_us = fly(method, substeps)
        error_mm = 1e3 * np.linalg.norm(places - reference, axis=1)
        rows.append((f"{method} {substeps}", cost_us, float(np.median(error_mm)), float(error_mm.max())))
        name, cost, median, worst = rows[-1]
        print(f"{name:<12}{cost:>12.2f}{1e3 / cost:>18.0f}{median:>18.4f}{worst:>12.3f}")
    if options.out:
        options.out.mkdir(parents=True, exist_ok=True)
        _write(options.out, rows)


def _write(out: Path, rows: list[tuple[str, float, float, float]]) -> None:
    lines = ["method,us_a_step,median_mm,worst_mm", *(f"{n},{c:.4f},{m:.6g},{w:.6g}" for n, c, m, w in rows)]
    (out / "tradeoff_envs.csv").write_text("\n".join(lines) + "\n")
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for kind, marker in (("split", "o"), ("guarded", "s")):
        some = [row for row in rows if row[0].startswith(kind)]
        axes.loglog([r[1] for r in some], [max(r[2], 1e-9) for r in some], marker + "-", label=kind)
        for name, cost, median, _ in some:
            axes.annotate(name.split()[1], (cost, max(median, 1e-9)), textcoords="offset points", xytext=(5, 5))
    axes.set(xlabel="processor time of an environment's step, us", ylabel="median error of place after 10 s, mm",
             title="Vectorised environments: error over cost, by substeps")
    ticks = [1, 2, 5, 10, 20]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()
    figure.savefig(out / "tradeoff_envs.png", dpi=120)


if __name__ == "__main__":
    main()
