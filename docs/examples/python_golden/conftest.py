# Tests import renderer.py from this folder, because pytest puts the folder of a conftest.py on the path.
