"""Synthetic clips of objects that move before a background, with their true positions.

from npchip.host.scenes import Disc, Linear, Object, Scene, render

ball = Object(shape=Disc(radius=5), motion=Linear(start=(20, 10), velocity=(0.5, 2)))
frames, truth = render(Scene(objects=(ball,), noise=2, seed=7))
truth.centers[0, 0]                  # (20.0, 10.0)
"""

from npchip.host.scenes.backgrounds import Background, Flat, Gradient, Texture
from npchip.host.scenes.files import read_scene
from npchip.host.scenes.model import Object, Scene
from npchip.host.scenes.motions import Accelerating, Bouncing, Circular, Linear, Motion
from npchip.host.scenes.output import write_clip
from npchip.host.scenes.render import Truth, render
from npchip.host.scenes.shapes import Disc, Dot, Polygon, Rectangle, Shape

__all__ = [
    "Accelerating",
    "Background",
    "Bouncing",
    "Circular",
    "Disc",
    "Dot",
    "Flat",
    "Gradient",
    "Linear",
    "Motion",
    "Object",
    "Polygon",
    "Rectangle",
    "Scene",
    "Shape",
    "Texture",
    "Truth",
    "read_scene",
    "render",
    "write_clip",
]
