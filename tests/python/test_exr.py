"""EXR files against OpenImageIO as the other reader and writer, and every mistake a script can make."""

import mesograin_native as native
import numpy as np
import OpenImageIO as oiio
import pytest


def random_image(shape, seed=1):
    return np.random.default_rng(seed).lognormal(0.0, 2.0, shape).astype(np.float32)


@pytest.mark.parametrize("half", [False, True])
def test_openimageio_reads_what_we_write(tmp_path, half):
    pixels = random_image((31, 45, 4))
    native.write_exr(tmp_path / "a.exr", pixels, attributes={"mesograin:seed": "7"}, half=half)
    buffer = oiio.ImageBuf(str(tmp_path / "a.exr"))
    spec = buffer.spec()
    assert spec.channelnames == ("R", "G", "B", "A")
    assert str(spec.format) == ("half" if half else "float")
    assert spec.get_string_attribute("compression") == "zip"
    assert spec.get_string_attribute("mesograin:seed") == "7"
    expected = pixels.astype(np.float16).astype(np.float32) if half else pixels
    np.testing.assert_array_equal(buffer.get_pixels(oiio.FLOAT), expected)


@pytest.mark.parametrize("tile", [0, 16])
def test_we_read_what_openimageio_writes(tmp_path, tile):
    pixels = random_image((31, 45, 5))
    spec = oiio.ImageSpec(45, 31, 5, oiio.FLOAT)
    spec.channelnames = ("R", "G", "B", "A", "depth.Z")
    spec.attribute("compression", "piz")
    spec.attribute("note", "from outside")
    if tile:
        spec.tile_width = spec.tile_height = tile
    output = oiio.ImageOutput.create(str(tmp_path / "a.exr"))
    assert output.open(str(tmp_path / "a.exr"), spec), oiio.geterror()
    assert output.write_image(pixels), output.geterror()
    output.close()
    back, channels, attributes = native.read_exr(str(tmp_path / "a.exr"))
    assert channels == ["R", "G", "B", "A", "depth.Z"]
    assert attributes["note"] == "from outside"
    assert back.dtype == np.float32 and back.flags.c_contiguous
    np.testing.assert_array_equal(back, pixels)


def test_grey_float64_and_strided_arrays_are_written(tmp_path):
    pixels = random_image((20, 30)).astype(np.float64)[::2, ::-1]
    native.write_exr(tmp_path / "a.exr", pixels)
    back, channels, _ = native.read_exr(tmp_path / "a.exr")
    assert channels == ["Y"] and back.shape == (10, 30, 1)
    np.testing.assert_array_equal(back[..., 0], pixels.astype(np.float32))


def test_mistakes_raise_one_sentence(tmp_path):
    (tmp_path / "file").write_text("x")
    pixels = random_image((4, 4, 3))
    for action, part in [
        (lambda: native.read_exr(tmp_path / "none.exr"), "There is no file"),
        (lambda: native.read_exr(tmp_path), "it is not one"),
        (lambda: native.read_exr(tmp_path / "file"), "not an OpenEXR file"),
        (lambda: native.write_exr(tmp_path / "none/a.exr", pixels), "its folder does not exist"),
        (lambda: native.write_exr(tmp_path / "file/a.exr", pixels), "is a file"),
        (lambda: native.write_exr("/proc/a.exr", pixels), "Can't write /proc/a.exr"),
        (lambda: native.write_exr(tmp_path / "a.exr", pixels, ["R", "G"]), "as many names"),
        (lambda: native.write_exr(tmp_path / "a.exr", pixels[0, 0]), "shape (h, w, channels) or (h, w); got (3)"),
        (lambda: native.write_exr(tmp_path / "a.exr", pixels[:0]), "got shape (0, 4, 3)"),
    ]:
        with pytest.raises(native.Error) as raised:
            action()
        assert part in str(raised.value)
        assert "\n" not in str(raised.value)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
