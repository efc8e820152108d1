"""Places and waters of a detector's pictures. Those of "test" occur in no other split, models of the place
included: "train" to learn from, "choose" (a place of its own, with waters and sand of "train") to choose the weights and
their temperature by, "test" for `detector`.

A place is TOML of a scene; {floor} is the height of its bottom, {assets} the folder of models and textures.
"""

SPLITS = {
    "train": {"waters": ["I", "IA", "II", "III", "1C", "5C"],
              "places": ["open", "sand", "tiles", "rocks", "rocks", "ridge", "relics", "relics", "kelp", "kelp", "blocks", "blocks", "cave"]},
    "choose": {"waters": ["IA", "III", "1C"], "places": ["reef"]},
    "test": {"waters": ["IB", "3C"], "places": ["wreck", "garden"]},
}
STREWN = ["strewn", "strewn_ridge"]  # to learn from too: bottoms with many small things
CLEAR = ["I", "IA", "II"]  # waters of "train" that show these far away
# Jerlov's type: how far things are shown, some three attenuation lengths.
FARTHEST_M = {"I": 20.0, "IA": 18.0, "IB": 15.0, "II": 12.0, "III": 8.0, "1C": 7.0, "3C": 5.0, "5C": 4.0}

_SAND = ('[[objects]]\nname = "floor"\nclass = "seabed"\nshape = "plane"\nsize_m = [160, 160]\nposition_m = [0, {floor}, 0]\n'
         'color_texture = "{assets}/textures/sand_color.jpg"\ntexture_m = 3\n')
_RIDGE = ('[[objects]]\nname = "floor"\nclass = "seabed"\nterrain = "{assets}/terrain/ridge.npy"\ncell_m = 0.5\n'
          'height_offset_m = {floor}\ncolor_texture = "{assets}/textures/sand_color.jpg"\n')
_SMALL = (("stones", "rock", "rocks.glb", "rock_1", 30, 0.15, 0.7), ("lumps", "rock", "rocks.glb", "rock_2", 30, 0.15, 0.8),
          ("fronds", "plant", "kelp.glb", "", 16, 0.1, 0.35), ("grass", "plant", "eelgrass.glb", "", 30, 0.5, 1.4),
          ("drums", "structure", "relics.glb", "drum", 8, 0.4, 1.0))
_SEABED = '[[objects]]\nname = "floor"\nclass = "seabed"\nmodel = "{assets}/models/seabed.glb"\nposition_m = [0, {floor}, 0]\n'


def _scattered(name, kind, model, node, count, smallest, largest, area_m=14):
    """So many copies of a model's node over the floor."""
    of = f'node = "{node}"\n' if node else ""
    return (f'[[objects]]\nname = "{name}"\nclass = "{kind}"\nmodel = "{{assets}}/models/{model}"\n{of}'
            f'scatter = {{{{ count = {count}, area_m = [-{area_m}, -{area_m}, {area_m}, {area_m}], on = "floor", '
            f'scale = [{smallest}, {largest}] }}}}\n')


def _blocks():
    """Walls, drums, posts and pipes of plain colours: edges of all directions that are no body."""
    out = _SAND
    colors = ["[0.5, 0.5, 0.48]", "[0.1, 0.1, 0.1]", "[0.55, 0.4, 0.1]", "[0.4, 0.12, 0.1]", "[0.8, 0.8, 0.75]", "[0.1, 0.25, 0.4]"]
    for i in range(18):
        x, z = 4.0 * (i % 6) - 10 + 0.7 * (i % 4), 8.0 * (i // 6) - 8 + 1.3 * (i % 3)
        if i % 3 == 0:
            shape = f'shape = "box"\nsize_m = [{0.6 + 0.5 * (i % 4)}, {0.4 + 0.9 * (i % 5)}, {0.3 + 0.4 * (i % 3)}]'
        else:
            shape = f'shape = "cylinder"\nradius_m = {0.08 + 0.12 * (i % 4)}\nheight_m = {1.0 + 0.9 * (i % 5)}'
        out += (f'[[objects]]\nname = "block_{i}"\nclass = "structure"\n{shape}\nposition_m = [{x}, {{floor}}, {z}]\n'
                f'yaw_deg = {37 * i % 180}\npitch_deg = {(0, 90, 25, 65)[i % 4]}\ncolor = {colors[i % 6]}\n')
    return out


PLACES = {
    "open": "",
    "sand": _SAND,
    "tiles": ('[[objects]]\nname = "floor"\nclass = "structure"\nshape = "plane"\nsize_m = [80, 80]\nposition_m = [0, {floor}, 0]\n'
              'color_texture = "{assets}/textures/tiles_color.jpg"\ntexture_m = 2\n'
              '[[objects]]\nname = "wall"\nclass = "structure"\nshape = "box"\nsize_m = [80, 8, 0.4]\nposition_m = [0, {floor}, -14]\n'
              'color_texture = "{assets}/textures/tiles_color.jpg"\ntexture_m = 2\n'),
    "rocks": (_SAND + _scattered("stones", "rock", "rocks.glb", "rock_1", 40, 0.6, 2.5, 16)
              + '[[objects]]\nname = "pipe"\nclass = "pipe"\nshape = "cylinder"\nradius_m = 0.3\nheight_m = 30\npitch_deg = 90\n'
                'position_m = [3, {floor}, 0]\ncolor = [0.3, 0.28, 0.2]\n'),
    "ridge": _RIDGE + _scattered("weed", "plant", "kelp.glb", "", 20, 0.4, 1.2, 12),
    "relics": (_RIDGE + _scattered("drums", "structure", "relics.glb", "drum", 18, 0.8, 2.0)
               + _scattered("anchors", "structure", "relics.glb", "anchor", 14, 0.8, 2.5)
               + _scattered("chains", "structure", "relics.glb", "chain", 6, 0.8, 2.0)
               + _scattered("nets", "structure", "relics.glb", "net", 6, 0.8, 2.0)),
    "kelp": (_SAND + _scattered("forest", "plant", "giant_kelp.glb", "", 16, 0.5, 1.0, 10)
             + _scattered("meadow", "plant", "eelgrass.glb", "", 80, 0.8, 2.0, 12)
             + _scattered("stones", "rock", "rocks.glb", "rock_2", 20, 0.6, 2.5)),
    "blocks": _blocks(),
    "cave": ('[[objects]]\nname = "walls"\nclass = "rock"\nmodel = "{assets}/models/cave.glb"\nposition_m = [-5, {floor}, -3]\n'
             '[[objects]]\nname = "more_walls"\nclass = "rock"\nmodel = "{assets}/models/cave.glb"\nposition_m = [5, {floor}, 3]\nyaw_deg = 130\n'
             + _SAND),
    "strewn": _SAND + "".join(_scattered(*of) for of in _SMALL),
    "strewn_ridge": _RIDGE + "".join(_scattered(*of) for of in _SMALL),
    "reef": (_SAND + "".join(_scattered(n, "coral", "reef.glb", n, c, 0.8, 2.2) for n, c in
                             (("brain", 14), ("table", 10), ("staghorn", 10), ("fan", 12), ("barrel_sponge", 10), ("tube_sponges", 10)))),
    "wreck": (_SEABED + '[[objects]]\nname = "submarine"\nclass = "wreck"\nmodel = "{assets}/models/submarine.glb"\n'
                        'position_m = [-6, {floor}, 0]\nyaw_deg = -3\nroll_deg = -9\n'),
    "garden": (_SEABED + _scattered("weed", "plant", "seagrass.glb", "", 60, 0.7, 1.6)
               + _scattered("coral", "coral", "corals.glb", "coral_0", 25, 0.7, 2.0)),
}
