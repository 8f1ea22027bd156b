"""Statistics of timings: what the programs of this directory say about their numbers."""

import math
import statistics

median = statistics.median


def spread(values):
    """Half the distance between the quartiles, as a share of the median."""
    if len(values) < 2:
        return 0.0
    low, _, high = statistics.quantiles(values, n=4, method="inclusive")
    return (high - low) / 2 / median(values)


def mann_whitney(a, b):
    """Two-sided p of the hypothesis that neither of a and b tends to be larger.

    Exact without ties and with at most 400 pairs, else the normal approximation with the correction
    for ties and continuity. H. B. Mann, D. R. Whitney, "On a Test of Whether one of Two Random
    Variables is Stochastically Larger than the Other", 1947.
    """
    u = sum((x > y) + 0.5 * (x == y) for x in a for y in b)
    n, m = len(a), len(b)
    values = list(a) + list(b)
    ties = [values.count(v) for v in set(values)]
    low = min(u, n * m - u)
    if max(ties) == 1 and n * m <= 400:
        counts = _orders_by_u(n, m)
        return min(1.0, 2.0 * sum(counts[: int(low) + 1]) / sum(counts))
    size = n + m
    variance = n * m / 12 * (size + 1 - sum(t**3 - t for t in ties) / (size * (size - 1)))
    if variance <= 0:
        return 1.0
    z = max(n * m / 2 - low - 0.5, 0.0) / math.sqrt(variance)
    return math.erfc(z / math.sqrt(2))


def _orders_by_u(n, m):
    """How many of the orders of n and m different values have U = 0, 1 .. n m: the coefficients of
    the Gaussian binomial, prod (1 - q^(m + i)) / (1 - q^i) for i = 1 .. n."""
    counts = [1] + [0] * (n * m)
    for i in range(1, n + 1):
        for u in range(n * m, m + i - 1, -1):
            counts[u] -= counts[u - m - i]
        for u in range(i, n * m + 1):
            counts[u] += counts[u - i]
    return counts


def fit_exponent(x, y):
    """k of y = c x^k, by least squares of the logarithms."""
    log_x, log_y = [math.log(v) for v in x], [math.log(v) for v in y]
    mean_x, mean_y = statistics.fmean(log_x), statistics.fmean(log_y)
    above = sum((p - mean_x) * (q - mean_y) for p, q in zip(log_x, log_y))
    return above / sum((p - mean_x) ** 2 for p in log_x)
