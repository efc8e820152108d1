"""Numbers of many runs: medians and shares with 95 % confidence intervals. No random draws: the same runs give the
same intervals."""
import math

Z95 = 1.959963984540054  # of the normal distribution, two-sided 95 %


def _binomial_at_most(k, n):
    """P(X <= k) of n fair coins, exact."""
    return sum(math.comb(n, i) for i in range(k + 1)) / 2 ** n


def quantile(values, share):
    """Linear between the sorted values (Hyndman and Fan 1996, type 7); they may be infinite, of one sign."""
    ordered = sorted(values)
    at = share * (len(ordered) - 1)
    low = math.floor(at)
    high = min(low + 1, len(ordered) - 1)
    if at == low or ordered[low] == ordered[high] or ordered[low] == -math.inf:
        return ordered[low]
    return ordered[low] + (at - low) * (ordered[high] - ordered[low])


def median_interval(values):
    """(median, low, high): the interval by order statistics, of at least 95 % for any distribution (Conover 1999,
    3.2). Below six values no two of them bound it: low and high are None."""
    ordered = sorted(values)
    n = len(ordered)
    if n == 0:
        return None, None, None
    k = -1
    while k + 1 < n // 2 and 2 * _binomial_at_most(k + 1, n) <= 0.05:
        k += 1
    middle = quantile(ordered, 0.5)
    return (middle, ordered[k], ordered[n - 1 - k]) if k >= 0 else (middle, None, None)


def share_interval(successes, n):
    """(share, low, high) by Wilson's score interval (Wilson 1927)."""
    if n == 0:
        return None, None, None
    p = successes / n
    middle = (p + Z95 ** 2 / (2 * n)) / (1 + Z95 ** 2 / n)
    half = Z95 / (1 + Z95 ** 2 / n) * math.sqrt(p * (1 - p) / n + Z95 ** 2 / (4 * n * n))
    return p, max(0.0, middle - half), min(1.0, middle + half)


def runs_to_tell(values, ratio=1.1, power=0.8):
    """Runs a group that tell a change of the mean by this ratio apart at 5 % (two-sided), with this power: the normal
    approximation for two groups, one of the spread that these values have, the other longer and wider by the ratio. None
    where they do not spread or are too few."""
    n = len(values)
    if n < 2:
        return None
    mean = sum(values) / n
    variance = sum((v - mean) ** 2 for v in values) / (n - 1)
    difference = abs(mean * (ratio - 1))
    if difference == 0:
        return None
    return max(2, math.ceil((1 + ratio ** 2) * variance * (Z95 + normal_quantile(power)) ** 2 / difference ** 2))


def power_of(values, runs, ratio=1.1):
    """The power of that test with `runs` runs a group."""
    n = len(values)
    mean = sum(values) / n
    variance = sum((v - mean) ** 2 for v in values) / (n - 1)
    if variance == 0:
        return 1.0
    return normal_share(abs(mean * (ratio - 1)) / math.sqrt((1 + ratio ** 2) * variance / runs) - Z95)


def power_by_draws(values, runs, ratio=1.1, draws=2000):
    """The same without the normal approximation: groups of `runs` runs are drawn from the values, one of them longer by the
    ratio, and Welch's test (1947) is made on each pair; from 20 runs on its limit is near the normal one. Counter-based draws."""
    import numpy as np
    rng = np.random.Generator(np.random.Philox(key=runs))
    have = np.asarray(values, float)
    a, b = (have[rng.integers(0, len(have), (draws, runs))] * r for r in (1.0, ratio))
    spread = np.sqrt(a.var(axis=1, ddof=1) / runs + b.var(axis=1, ddof=1) / runs)
    return float((np.abs(b.mean(axis=1) - a.mean(axis=1)) > Z95 * spread).mean())


def normal_share(z):
    """P(Z <= z) of the standard normal distribution."""
    return 0.5 * (1 + math.erf(z / math.sqrt(2)))


def normal_quantile(share):
    """Inverse of normal_share, by bisection to 1e-12."""
    low, high = -10.0, 10.0
    while high - low > 1e-12:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if normal_share(middle) < share else (low, middle)
    return 0.5 * (low + high)
