"""A small ONNX network read as a PyTorch module, so that training goes on from the weights of a file.

Reads what training.py writes: convolutions, sums, rectifiers, pools and a last layer, whose softmax is left out. Written from
the ONNX specification's onnx.proto; protobuf's wire format is read here, since Debian's PyTorch needs no onnx package.
"""
import struct

import numpy as np

from scenario import Refused


def _fields(data):
    """(field number, value) of a message: numbers as they are, the rest as bytes."""
    at = 0

    def number():
        nonlocal at
        out = shift = 0
        while True:
            byte = data[at]
            at += 1
            out |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return out
            if shift > 63:
                raise ValueError("a number of more than 64 bits")
    while at < len(data):
        key = number()
        kind = key & 7
        if kind == 0:
            yield key >> 3, number()
        elif kind == 2:
            size = number()
            yield key >> 3, data[at:at + size]
            at += size
        elif kind in (1, 5):
            size = 8 if kind == 1 else 4
            yield key >> 3, data[at:at + size]
            at += size
        else:
            raise ValueError(f"wire type {kind}")


def _numbers(value):
    """Packed or single whole numbers."""
    if isinstance(value, int):
        return [value]
    return [v for _, v in _fields(b"".join(b"\x08" + part for part in _varints(value)))]


def _varints(data):
    part = b""
    for byte in data:
        part += bytes([byte])
        if byte < 128:
            yield part
            part = b""


def _tensor(data):
    name, shape, kind, raw, floats = "", [], 0, b"", b""
    for field, value in _fields(data):
        if field == 1:
            shape += _numbers(value)
        elif field == 2:
            kind = value
        elif field == 4:
            floats += value
        elif field == 8:
            name = value.decode()
        elif field == 9:
            raw = value
    if kind not in (1, 7):  # float, int64
        raise ValueError(f"tensor {name} of type {kind}")
    return name, np.frombuffer(raw or floats, "<f4" if kind == 1 else "<i8").reshape(shape).copy()


def _node(data):
    out = {"inputs": [], "outputs": [], "kind": "", "of": {}}
    for field, value in _fields(data):
        if field == 1:
            out["inputs"].append(value.decode())
        elif field == 2:
            out["outputs"].append(value.decode())
        elif field == 4:
            out["kind"] = value.decode()
        elif field == 5:
            name, values = "", []
            for part, v in _fields(value):
                if part == 1:
                    name = v.decode()
                elif part == 2:
                    values = struct.unpack("<f", v)
                elif part in (3, 8):
                    values = [*values, *_numbers(v)]
                elif part == 5:
                    values = _tensor(v)[1]
            out["of"][name] = values
    return out


def read(path):
    """(nodes in order, {name: array})."""
    with open(path, "rb") as file:
        data = file.read()
    try:
        graph = dict(_fields(data))[7]
        parts = list(_fields(graph))
        return [_node(v) for f, v in parts if f == 1], dict(_tensor(v) for f, v in parts if f == 5)
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, struct.error) as error:
        raise Refused(f"{path}: found no ONNX network ({error}); accepted: one that train_camera or train_sonar wrote") from None


def outputs_of(path):
    """The names of a network's outputs, in the file's order."""
    with open(path, "rb") as file:
        data = file.read()
    try:
        names = [dict(_fields(v))[1].decode() for f, v in _fields(dict(_fields(data))[7]) if f == 12]
    except (ValueError, KeyError, IndexError, TypeError, AttributeError) as error:
        raise Refused(f"{path}: found no ONNX network ({error!r}); accepted: a detector's .onnx") from None
    if not names:
        raise Refused(f"{path}: found a network without outputs; accepted: a detector's .onnx")
    return names


def module_of(torch, path):
    """The network of a file: crops to logits, with `last` as its last layer."""
    nodes, arrays = read(path)
    if nodes and nodes[-1]["kind"] == "Softmax":
        nodes = nodes[:-1]
    nothing = {n["outputs"][0] for n in nodes if n["kind"] == "Constant" and not np.any(n["of"].get("value", 1))}
    nodes = [dict(n, kind="Identity") if n["kind"] == "Pad" and nothing.issuperset(n["inputs"][1:]) else n
             for n in nodes if n["kind"] != "Constant"]
    known = {"Conv", "Relu", "Add", "AveragePool", "MaxPool", "Concat", "Flatten", "Gemm", "Identity"}
    strange = sorted({n["kind"] for n in nodes} - known)
    if strange or not nodes or nodes[-1]["kind"] != "Gemm":
        raise Refused(f"{path}: found {', '.join(strange) or 'no last layer'}; accepted: a network that train_camera or train_sonar wrote")
    nn, act = torch.nn, torch.nn.functional

    class Network(nn.Module):
        def __init__(self):
            super().__init__()
            self.layers = nn.ModuleDict()
            for i, node in enumerate(nodes):
                if node["kind"] not in ("Conv", "Gemm"):
                    continue
                weight, bias = (torch.tensor(arrays[n]) for n in node["inputs"][1:3])
                if node["kind"] == "Conv":
                    layer = nn.Conv2d(weight.shape[1], weight.shape[0], tuple(weight.shape[2:]), node["of"]["strides"][0], node["of"]["pads"][0])
                else:
                    layer = nn.Linear(weight.shape[1], weight.shape[0])
                layer.weight.data, layer.bias.data = weight, bias
                self.layers[str(i)] = layer
            self.last = layer

        def forward(self, x):
            have = {nodes[0]["inputs"][0]: x}
            for i, node in enumerate(nodes):
                of, kind = [have.get(n) for n in node["inputs"]], node["kind"]
                if str(i) in self.layers:
                    y = self.layers[str(i)](of[0])
                elif kind == "Relu":
                    y = act.relu(of[0])
                elif kind == "Add":
                    y = of[0] + of[1]
                elif kind == "Concat":
                    y = torch.cat(of, node["of"]["axis"][0])
                elif kind == "Flatten":
                    y = of[0].flatten(node["of"].get("axis", [1])[0])
                elif kind == "Identity":
                    y = of[0]
                else:
                    pool = act.avg_pool2d if kind == "AveragePool" else act.max_pool2d
                    y = pool(of[0], tuple(node["of"]["kernel_shape"]), tuple(node["of"]["strides"]))
                have[node["outputs"][0]] = y
            return y

    return Network()
