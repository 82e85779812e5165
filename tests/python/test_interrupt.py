"""Ctrl-C ends a long frame, and other threads run while one is drawn."""

import os
import signal
import threading
import time

import pytest
import trueshade


def test_ctrl_c_ends_a_frame():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background is told to ignore it
    scene = trueshade.load_scene("builtin:city")
    pipeline = trueshade.Pipeline(size=(12000, 12000))
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        trueshade.render(scene, pipeline)
    assert time.monotonic() - start < 10
    assert trueshade.render(scene, trueshade.Pipeline(size=(16, 16))).color.shape == (16, 16, 4)


def test_other_threads_run_while_a_frame_is_drawn():
    scene = trueshade.load_scene("builtin:city")
    counted = []
    stop = threading.Event()

    def count():
        while not stop.is_set():
            counted.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.monotonic()
    trueshade.render(scene, trueshade.Pipeline(size=(3000, 3000)))
    end = time.monotonic()
    stop.set()
    thread.join()
    during = [t for t in counted if start < t < end]
    assert len(during) > (end - start) * 20


def test_a_scene_that_is_drawn_is_not_changed_meanwhile():
    scene = trueshade.load_scene("builtin:city")
    refused = []
    started = threading.Event()

    def draw():
        started.set()
        trueshade.render(scene, trueshade.Pipeline(size=(4000, 4000)))

    thread = threading.Thread(target=draw)
    thread.start()
    started.wait()
    while thread.is_alive():
        try:
            scene.set_time(0.0)
        except trueshade.Error as error:
            refused.append(str(error))
        time.sleep(0.001)
    thread.join()
    assert refused and "another thread draws it" in refused[0]
    scene.set_clear((0, 0, 0, 1))


def test_two_threads_draw_one_scene():
    scene = trueshade.load_scene("builtin:city")
    hashes = []
    threads = [
        threading.Thread(target=lambda: hashes.append(trueshade.render(scene, trueshade.Pipeline(size=(200, 150))).hash))
        for _ in range(6)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(hashes) == 6 and len(set(hashes)) == 1
