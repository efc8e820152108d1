"""assets/vehicles/t200_thrust.csv from the maker's published measurements (a .csv of pwm_us and
thrust_N_10V ... thrust_N_20V). A least-squares fit by straight pieces, monotone and 0 in the dead
band, rounded to 0.01 N: fewer rows, no noise.  python3 t200_table.py MEASURED.csv"""
import sys

import numpy as np

VOLTS = [10, 12, 14, 16, 18, 20]
KNOTS = np.r_[1100:1440:20, 1440:1480:4, 1524:1560:4, 1560:1901:20].astype(float)


def hats(x):
    """Row i: the weights that straight pieces between KNOTS give to each knot at x[i]."""
    rows = np.zeros((len(x), len(KNOTS)))
    for j in range(len(KNOTS)):
        rows[:, j] = np.interp(x, KNOTS, np.eye(len(KNOTS))[j])
    return rows


def monotone(values):
    """The nearest non-falling sequence (pool adjacent violators)."""
    pools = []
    for v in values:
        pools.append([v, 1])
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            b, a = pools.pop(), pools.pop()
            n = a[1] + b[1]
            pools.append([(a[0] * a[1] + b[0] * b[1]) / n, n])
    return np.concatenate([[v] * n for v, n in pools])


def main():
    lines = [line for line in open(sys.argv[1]) if line[0] not in "#p"]
    data = np.array([[float(x) for x in line.split(",")[:7]] for line in lines])
    x, rows = data[:, 0], hats(data[:, 0])
    columns = []
    for k in range(len(VOLTS)):
        fit = np.linalg.lstsq(rows, data[:, k + 1], rcond=None)[0]
        still = np.interp(KNOTS, x, data[:, k + 1]) == 0.0
        fit[still] = 0.0
        fit = np.round(monotone(fit), 2)
        off = rows @ fit - data[:, k + 1]
        print(f"{VOLTS[k]} V: rms {np.sqrt(np.mean(off**2)):.3f} N, most {np.abs(off).max():.3f} N")
        columns.append(fit)
    with open("../../assets/vehicles/t200_thrust.csv", "w") as out:
        out.write(
            "# Thrust of a Blue Robotics T200 against pulse width and supply voltage, static.\n"
            "# Source: Blue Robotics, T200 public performance data, September 2019\n"
            "# (https://bluerobotics.com/store/thrusters/t100-t200-thrusters/t200-thruster-r2-rp/).\n"
            "# Fitted to the measurements by tools/assets/t200_table.py: monotone, rms 0.11 N.\n"
            "pwm_us," + ",".join(f"thrust_n_{v}v" for v in VOLTS) + "\n")
        for i, knot in enumerate(KNOTS):
            out.write(f"{knot:.0f}," + ",".join(f"{c[i] + 0.0:.2f}" for c in columns) + "\n")


main()
