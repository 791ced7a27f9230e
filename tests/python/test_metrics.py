"""Metrics against numpy and OpenImageIO, on random HDR images with and without NaN and Inf."""

import json

import mesograin_native as native
import numpy as np
import OpenImageIO as oiio
import pytest

EPSILON = 0.01


def random_pair(shape=(67, 45, 3), seed=0):
    """An image and two noisy references of radiances over many magnitudes."""
    generator = np.random.default_rng(seed)
    truth = generator.lognormal(-1.0, 2.5, shape)
    return [(truth * generator.lognormal(0.0, spread, shape)).astype(np.float32) for spread in (0.3, 0.1, 0.1)]


def expected_errors(difference, reference, weight=1.0):
    weight = np.broadcast_to(weight, reference.shape)

    def mean(values):
        return (weight * values).sum() / weight.sum()

    rse = difference**2 / (reference**2 + EPSILON)
    return {
        "ae_mean": mean(abs(difference)),
        "se_mean": mean(difference**2),
        "rae_mean": mean(abs(difference) / (reference + EPSILON)),
        "rse_mean": mean(rse),
        "rse_root_mean": mean(np.sqrt(rse)),
        "mse": mean(difference**2),
        "rmse": np.sqrt(mean(difference**2)),
        "relative_l1": (weight * abs(difference)).sum() / (weight * reference).sum(),
    }


def expected_blocks(values, mask):
    """Means over the masked pixels of each 8 x 8 block, and how many they are."""
    means, counts = [], []
    for top in range(0, mask.shape[0], 8):
        for left in range(0, mask.shape[1], 8):
            block = np.s_[top:top + 8, left:left + 8]
            if mask[block].any():
                means.append(values[block][mask[block]].mean(axis=0))
                counts.append(mask[block].sum())
    return np.array(means), np.array(counts, dtype=float)[:, None]


def check_against_numpy(result, image, a, b, mask):
    image, a, b = (values.astype(np.float64) for values in (image, a, b))
    finite = np.isfinite(image).all(-1) & np.isfinite(a).all(-1) & np.isfinite(b).all(-1)
    used = mask & finite
    image, a, b = (np.where(used[..., None], values, 0.0) for values in (image, a, b))
    reference = 0.5 * (a + b)
    difference = image - reference
    spread = 0.5 * (a - b)

    pixels = expected_errors(difference[used], reference[used])
    floor = expected_errors(spread[used], reference[used])
    block_difference, weight = expected_blocks(difference, used)
    block_reference, _ = expected_blocks(reference, used)
    block_spread, _ = expected_blocks(spread, used)
    blocks = expected_errors(block_difference, block_reference, weight)
    blocks_floor = expected_errors(block_spread, block_reference, weight)
    for name in pixels:
        assert result[name] == pytest.approx(pixels[name], rel=1e-6)
        assert result["noise_floor"][name] == pytest.approx(floor[name], rel=1e-6)
        assert result[name + "_blocks"] == pytest.approx(blocks[name], rel=1e-6)
        assert result["noise_floor"][name + "_blocks"] == pytest.approx(blocks_floor[name], rel=1e-6)
        for value, noise, suffix in ((pixels, floor, "_corrected"), (blocks, blocks_floor, "_blocks_corrected")):
            power = 1 if name in ("se_mean", "rse_mean", "mse") else 2
            corrected = max(0.0, value[name]**power - noise[name]**power)**(1 / power)
            assert result[name + suffix] == pytest.approx(corrected, rel=1e-6, abs=1e-9)

    assert result["e_mean"] == pytest.approx(difference[used].mean(), rel=1e-6)
    assert result["bias"] == pytest.approx(image[used].sum() / reference[used].sum(), rel=1e-6)
    rse = difference**2 / (reference**2 + EPSILON)
    for name, values in (("ae", abs(difference)), ("rse", rse)):
        for part in (50, 95, 99):
            assert result[f"{name}_p{part}"] == pytest.approx(np.percentile(values[used], part), rel=1e-6)
    for name, values in (("max_error", abs(difference)), ("rse_max", rse)):
        y, x, channel = np.unravel_index(np.argmax(np.where(used[..., None], values, -1.0)), values.shape)
        assert result[name] == pytest.approx(values[y, x, channel], rel=1e-6)
        assert result[name + "_at"] == [x, y, channel]
    assert result["mask"]["pixels"] == mask.sum()
    assert result["mask"]["used"] == used.sum()
    json.dumps(result, allow_nan=False)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("masked", [False, True])
def test_numpy_agrees(seed, masked):
    image, a, b = random_pair(seed=seed)
    mask = np.random.default_rng(seed).random(image.shape[:2]) < (0.4 if masked else 2.0)
    result = native.compare(image, a, b, mask=mask if masked else None)
    check_against_numpy(result, image, a, b, mask)
    assert result["mask"]["source"] == ("given" if masked else "all pixels")
    assert result["mask"]["nan"] == result["mask"]["inf"] == 0


@pytest.mark.parametrize("seed", range(4))
def test_nan_and_inf_are_counted_exactly_and_left_out(seed):
    images = random_pair(seed=seed)
    generator = np.random.default_rng(seed)
    for image in images:
        for value in (np.nan, np.inf, -np.inf):
            image[generator.random(image.shape) < 0.01] = value
    image, a, b = images
    mask = generator.random(image.shape[:2]) < 0.7
    result = native.compare(image, a, b, mask=mask)
    check_against_numpy(result, image, a, b, mask)
    has_nan = np.isnan(images).any(axis=(0, 3)) & mask
    has_inf = np.isinf(images).any(axis=(0, 3)) & mask
    assert result["mask"]["nan"] == has_nan.sum()
    assert result["mask"]["inf"] == (has_inf & ~has_nan).sum()
    assert result["mask"]["image_not_finite"] == (~np.isfinite(image).all(-1) & mask).sum()


@pytest.mark.parametrize("seed", range(3))
def test_openimageio_agrees(seed):
    image, reference, _ = random_pair(seed=seed)
    buffers = []
    for pixels in (image, reference):
        buffers.append(oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, oiio.FLOAT)))
        assert buffers[-1].set_pixels(oiio.ROI(), pixels)
    theirs = oiio.ImageBufAlgo.compare(*buffers, 1e30, 1e30)
    ours = native.compare(image, reference)
    assert ours["ae_mean"] == pytest.approx(theirs.meanerror, rel=1e-6)
    assert ours["rmse"] == pytest.approx(theirs.rms_error, rel=1e-6)
    assert ours["max_error"] == pytest.approx(theirs.maxerror, rel=1e-6)
    assert ours["max_error_at"] == [theirs.maxx, theirs.maxy, theirs.maxc]


def test_one_reference_has_no_known_noise():
    image, reference, _ = random_pair()
    result = native.compare(image, reference)
    assert set(result["noise_floor"].values()) == {None}
    assert result["relative_l1_corrected"] is None


def test_a_black_reference_has_no_relative_values():
    black = np.zeros((9, 9, 3), np.float32)
    result = native.compare(black + 1, black, black)
    assert result["bias"] is None and result["relative_l1"] is None and result["relative_l1_corrected"] is None
    assert result["rse_mean"] == pytest.approx(1 / EPSILON)
    json.dumps(result, allow_nan=False)


def test_alpha_makes_the_default_mask_and_is_not_compared():
    image, reference, _ = random_pair((40, 40, 4))
    y, x = np.mgrid[:40, :40]
    reference[..., 3] = np.hypot(x - 20, y - 20) < 15
    mask = native.default_mask(reference[..., 3])
    assert mask.dtype == bool and mask.shape == (40, 40)
    assert 0 < mask.sum() < reference[..., 3].sum()
    assert native.default_mask(reference[..., 3], erode=0).sum() == reference[..., 3].sum()
    result = native.compare(image, reference)
    assert result["mask"]["source"] == "reference coverage"
    given = native.compare(image[..., :3], reference[..., :3], mask=mask)
    assert result["rse_mean"] == given["rse_mean"] and result["mask"]["pixels"] == mask.sum()


@pytest.mark.parametrize("metric", ["e", "ae", "se", "rae", "rse", "rse_root"])
def test_error_images_average_to_the_metrics(metric):
    image, a, b = random_pair()
    errors = native.error_image(image, a, b, metric=metric)
    assert errors.dtype == np.float32 and errors.shape == image.shape
    result = native.compare(image, a, b)
    assert errors.mean(dtype=np.float64) == pytest.approx(result[metric + "_mean"], rel=1e-6)


def test_error_images_keep_nan():
    image, reference, _ = random_pair()
    image[3, 4, 1] = np.nan
    errors = native.error_image(image, reference)
    assert np.argwhere(np.isnan(errors)).tolist() == [[3, 4, 1]]


def test_mistakes_raise_one_sentence():
    image, reference, _ = random_pair((4, 5, 3))
    for action, part in [
        (lambda: native.compare(image, reference[:3]), "5 x 4 and 5 x 3"),
        (lambda: native.compare(image[..., :2], reference), "1, 3 or 4 channels; got 2"),
        (lambda: native.compare(image, reference[..., :1]), "both be grey or both be RGB"),
        (lambda: native.compare(image, reference, mask=np.zeros((4, 5), bool)), "selects no pixel"),
        (lambda: native.compare(image, reference, mask=np.ones(20, bool)), "mask must have shape (h, w)"),
        (lambda: native.compare(image, reference * np.nan), "None of the 20 masked pixels"),
        (lambda: native.error_image(image, reference, metric="psnr"), "got 'psnr'"),
        (lambda: native.default_mask(image), "one channel; got 3"),
        (lambda: native.default_mask(image[..., 0], erode=-1), "0 or more"),
    ]:
        with pytest.raises(native.Error, match=r"\.$") as raised:
            action()
        assert part in str(raised.value)
