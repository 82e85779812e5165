"""Where the command is that the module is held to."""

import os
import subprocess

import pytest


@pytest.fixture
def command(tmp_path):
    """Runs `trueshade ARGUMENTS...` in a scratch folder and returns what it printed."""

    def run(*arguments):
        done = subprocess.run(
            [os.environ["TRUESHADE_COMMAND"], *map(str, arguments)], capture_output=True, text=True, cwd=tmp_path
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    run.folder = tmp_path
    return run
