"""The package as a whole."""

import importlib.metadata

import exactfold


def test_the_version_is_that_of_the_installed_package():
    assert exactfold.__version__ == importlib.metadata.version("exactfold")


def test_every_public_name_is_there():
    for name in exactfold.__all__:
        assert getattr(exactfold, name) is not None
    assert set(exactfold.__all__) <= set(dir(exactfold))
