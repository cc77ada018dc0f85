"""Order of a few numbers, without sorting them all."""

__all__ = ["mean_of_least", "median", "select"]


def select(numbers, count, place):
    """Bring the number of a `place` in order there, none larger before it and none smaller behind it (Hoare).

    Args:
        numbers: The first `count` of them are finite, and are moved.
    """
    low, high = 0, count - 1
    while low < high:
        pivot = numbers[(low + high) // 2]
        i, j = low, high
        while i <= j:
            while numbers[i] < pivot:
                i += 1
            while numbers[j] > pivot:
                j -= 1
            if i <= j:
                kept = numbers[i]
                numbers[i], numbers[j] = numbers[j], kept
                i += 1
                j -= 1
        if place <= j:
            high = j
        elif place >= i:
            low = i
        else:
            return


def median(numbers, count):
    """Median of the first `count` numbers, at least one, finite; they are moved."""
    half = count // 2
    select(numbers, count, half)
    if count % 2:
        return numbers[half]
    below = numbers[0]
    for i in range(1, half):
        below = max(below, numbers[i])
    return 0.5 * (below + numbers[half])


def mean_of_least(numbers, count, least):
    """Mean of the `least` smallest of the first `count` numbers, finite; they are moved."""
    select(numbers, count, least - 1)
    total = 0.0
    for i in range(least):
        total += numbers[i]
    return total / least
