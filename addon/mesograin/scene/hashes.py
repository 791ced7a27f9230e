# Numbers that look random, of numbers: Bob Jenkins' lookup3 (burtleburtle.net/bob/c/lookup3.c) and the PCG hashes of
# Jarzynski and Olano ("Hash Functions for GPU Rendering", 2020), as Blender's textures ask for them.
import numpy as np

WORD = np.uint32


def _turned(value, by):
    return (value << WORD(by)) | (value >> WORD(32 - by))


def _scrambled(a, b, c):
    """lookup3's last step; its third word."""
    words = [a, b, c]
    for into, of, by in ((2, 1, 14), (0, 2, 11), (1, 0, 25), (2, 1, 16), (0, 2, 4), (1, 0, 14), (2, 1, 24)):
        words[into] = (words[into] ^ words[of]) - _turned(words[of], by)
    return words[2]


def _stirred(a, b, c):
    """lookup3's step between one three words and the next."""
    words = [a, b, c]
    for first, second, third, by in ((0, 2, 1, 4), (1, 0, 2, 6), (2, 1, 0, 8), (0, 2, 1, 16), (1, 0, 2, 19),
                                     (2, 1, 0, 4)):
        words[first] = (words[first] - words[second]) ^ _turned(words[second], by)
        words[second] = words[second] + words[third]
    return words


def of_words(*keys):
    """(n,) uint32 of one to four arrays of uint32 or numbers."""
    keys = [np.asarray(key, dtype=WORD) for key in keys]
    shape = np.broadcast_shapes(*(key.shape for key in keys))
    with np.errstate(over="ignore"):
        seed = np.full(shape, 0xDEADBEEF + (len(keys) << 2) + 13, dtype=WORD)
        words = [seed, seed, seed]
        for place, key in enumerate(keys[:3]):
            words[place] = words[place] + key
        if len(keys) == 4:
            words = _stirred(*words)
            words[0] = words[0] + keys[3]
        return _scrambled(*words)


def of_whole(*keys):
    """The same of arrays of whole numbers, of either sign."""
    return of_words(*(np.asarray(key).astype(np.int64).astype(WORD) for key in keys))


def share_of_numbers(*keys):
    """(n,) from 0 to 1 of one to four arrays of numbers, by their bits in single precision."""
    words = of_words(*(np.atleast_1d(np.asarray(key, dtype=np.float32)).view(WORD) for key in keys))
    return words.astype(np.float64) / 0xFFFFFFFF


def shares_of_cell(cell):
    """(n, 3) from 0 to 1 of (n, 1 to 4) whole numbers: as many numbers as they are, and no fewer than three."""
    keys = [np.asarray(cell)[:, axis].astype(np.float32) for axis in range(cell.shape[1])]
    if len(keys) == 4:
        return np.stack([share_of_numbers(*(keys[axis] for axis in order))
                         for order in ((0, 1, 2, 3), (3, 0, 1, 2), (2, 3, 0, 1), (1, 2, 3, 0))], axis=1)
    return np.stack([share_of_numbers(*keys), share_of_numbers(*keys, 1.0), share_of_numbers(*keys, 2.0)], axis=1)


def colours_of_cell(cell):
    """(n, 3) from 0 to 1 of (n, 1 to 4) numbers."""
    if cell.shape[1] < 4:
        return shares_of_cell(cell)
    keys = [np.asarray(cell)[:, axis].astype(np.float32) for axis in range(4)]
    return np.stack([share_of_numbers(*(keys[axis] for axis in order))
                     for order in ((0, 1, 2, 3), (2, 0, 3, 1), (3, 2, 1, 0))], axis=1)
