"""Numbers of many runs: medians, means, shares and differences of two conditions with 95 % confidence intervals. The same runs give the
same intervals: draws, where there are any, are by a counter."""
import functools
import math

LEAST = 3  # runs or pairs: of two, the spread is a guess
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


def mean_interval(values):
    """(mean, low, high) by Student's t, of normal values; None, None below LEAST of them."""
    if not values:
        return None, None, None
    mean = sum(values) / len(values)
    if len(values) < LEAST:
        return mean, None, None
    half = t_limit(len(values) - 1) * math.sqrt(_moments(values)[1] / len(values))
    return mean, mean - half, mean + half


def share_difference_interval(pairs):
    """(difference, low, high) of two shares of the same runs, from pairs of truths: the first's share less the second's. Newcombe 1998
    (Improved confidence intervals for the difference between binomial proportions based on paired data), method 10: Wilson's limits of each,
    with the correlation of the two."""
    n = len(pairs)
    if n == 0:
        return None, None, None
    both, first, second = (sum(1 for p in pairs if p == kind) for kind in ((True, True), (True, False), (False, True)))
    neither = n - both - first - second
    p1, l1, u1 = share_interval(both + first, n)
    p2, l2, u2 = share_interval(both + second, n)
    product = (both + first) * (second + neither) * (both + second) * (first + neither)
    together = both * neither - first * second
    together = max(0.0, together - n / 2) if together > 0 else together  # continuity
    phi = together / math.sqrt(product) if product else 0.0
    below = (p1 - l1) ** 2 - 2 * phi * (p1 - l1) * (u2 - p2) + (u2 - p2) ** 2
    above = (u1 - p1) ** 2 - 2 * phi * (u1 - p1) * (p2 - l2) + (p2 - l2) ** 2
    return p1 - p2, p1 - p2 - math.sqrt(below), p1 - p2 + math.sqrt(above)


def median_difference_interval(pairs, draws=2000):
    """(difference, low, high) of two medians of the same runs, from pairs of numbers, of which the first's may be infinite with one sign and
    the second's with the other: percentiles of the difference over resampled pairs (Efron and Tibshirani 1993, 13.3), farther out for few
    pairs, whose resamplings spread too little: normal P(-sqrt(n / (n - 1)) t) on each side, with Student's t of n - 1 (Hesterberg 2015, What
    teachers should know about the bootstrap, 4.3, expanded percentiles). Below six pairs low and high are None, as of one median."""
    import numpy as np
    if not pairs:
        return None, None, None
    both = np.array(pairs, float)

    def difference(values):  # [..., pairs, 2]
        ordered, n = np.sort(values, axis=-2), len(pairs)
        low, high = ordered[..., (n - 1) // 2, :], ordered[..., n // 2, :]
        middle = np.where(low == high, low, 0.5 * (low + high))
        return middle[..., 0] - middle[..., 1]
    found = float(difference(both))
    if len(pairs) < 6:
        return found, None, None
    rng = np.random.Generator(np.random.Philox(key=len(pairs)))
    drawn = np.sort(difference(both[rng.integers(0, len(pairs), (draws, len(pairs)))]))
    n = len(pairs)
    out = int(0.5 * math.erfc(math.sqrt(n / (n - 1)) * t_limit(n - 1) / math.sqrt(2)) * draws)
    return found, float(drawn[out]), float(drawn[-1 - out])


def runs_to_tell(values, ratio=1.1, power=0.8):
    """Runs a group, LEAST or more, that tell a change of the mean by this ratio apart at 5 % (two-sided), with this power:
    Welch's test (1947) of two normal groups, one of the spread that these values have, the other longer and wider by the
    ratio. None where they do not spread or are too few."""
    if len(values) < 2 or not any(values):
        return None
    return _least(lambda n: power_of(values, n, ratio), power)


def power_of(values, runs, ratio=1.1):
    """The power of that test with `runs` runs a group, LEAST or more, by the noncentral t distribution with Welch's degrees of
    freedom."""
    mean, variance = _moments(values)
    if variance == 0:
        return 1.0
    freedom = (runs - 1) * (1 + ratio ** 2) ** 2 / (1 + ratio ** 4)
    return _t_power(abs(mean * (ratio - 1)) / math.sqrt((1 + ratio ** 2) * variance / runs), freedom)


def pairs_to_tell(change, deviation, power=0.8):
    """Pairs, LEAST or more, that tell a mean difference of `change` apart from none at 5 % (two-sided) where the differences
    deviate so much: the paired t test, exact for normal differences. None where the change is none."""
    return None if change == 0 else _least(lambda n: paired_power(change, deviation, n), power)


def paired_power(change, deviation, pairs):
    """The power of that test with `pairs` pairs, LEAST or more."""
    return 1.0 if deviation == 0 else _t_power(abs(change) / deviation * math.sqrt(pairs), pairs - 1)


def _moments(values):
    mean = sum(values) / len(values)
    return mean, sum((v - mean) ** 2 for v in values) / (len(values) - 1)


def _least(power_at, power):
    """The least number of at least LEAST whose power is reached; power_at rises."""
    high = LEAST
    while power_at(high) < power:
        high *= 2
        if high > 2 ** 40:
            return None
    low = max(LEAST - 1, high // 2)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if power_at(middle) >= power else (middle, high)
    return high


def _t_above(t, freedom, shift=0.0):
    """P(T > t) of Student's t with a shift (noncentrality): the mean of the normal share over the chi distribution of the
    deviation that is found, by Simpson's rule (Johnson, Kotz and Balakrishnan 1995, 31.2). Two degrees of freedom or more."""
    half = 10.0 / math.sqrt(2.0 * freedom)
    low, high, n = max(0.0, 1.0 - half), 1.0 + half, 400
    log_scale = math.log(2.0) + 0.5 * freedom * math.log(0.5 * freedom) - math.lgamma(0.5 * freedom)
    total = 0.0
    for i in range(n + 1):
        s = low + (high - low) * i / n
        if s > 0.0:
            weight = 1 if i in (0, n) else 4 if i % 2 else 2
            total += weight * math.exp(log_scale + (freedom - 1.0) * math.log(s) - 0.5 * freedom * s * s) * normal_share(shift - t * s)
    return total * (high - low) / (3.0 * n)


@functools.lru_cache(maxsize=4096)
def t_limit(freedom):
    """What Student's t leaves 2.5 % above: by bisection, of many degrees of freedom by the expansion of Abramowitz and
    Stegun 1964, 26.7.5."""
    z = Z95
    many = z + (z ** 3 + z) / (4 * freedom) + (5 * z ** 5 + 16 * z ** 3 + 3 * z) / (96 * freedom ** 2)
    if freedom > 200:
        return many
    low, high = z, 5.0  # of two degrees of freedom it is 4.30
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _t_above(middle, freedom) > 0.025 else (low, middle)
    return 0.5 * (low + high)


def _t_power(shift, freedom):
    """The power of a two-sided t test at 5 %: what lies above either limit."""
    if shift > 30.0:
        return 1.0
    limit = t_limit(freedom)
    return _t_above(limit, freedom, shift) + _t_above(limit, freedom, -shift)


def power_by_draws(values, runs, ratio=1.1, draws=2000):
    """The same without the normal approximation: groups of `runs` runs are drawn from the values, one of them longer by the
    ratio, and Welch's test (1947) is made on each pair, at its limit of t. Counter-based draws."""
    import numpy as np
    rng = np.random.Generator(np.random.Philox(key=runs))
    have = np.asarray(values, float)
    a, b = (have[rng.integers(0, len(have), (draws, runs))] * r for r in (1.0, ratio))
    spread = np.sqrt(a.var(axis=1, ddof=1) / runs + b.var(axis=1, ddof=1) / runs)
    return float((np.abs(b.mean(axis=1) - a.mean(axis=1)) > t_limit((runs - 1) * (1 + ratio ** 2) ** 2 / (1 + ratio ** 4)) * spread).mean())


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
