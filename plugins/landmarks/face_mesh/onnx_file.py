# SPDX-License-Identifier: Apache-2.0
"""Writes ONNX, which is Protocol Buffers: the few messages of onnx.proto that a network of convolutions needs."""
import struct


def _varint(value):
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    out.append(value)
    return bytes(out)


def _number(field, value):
    return _varint(field << 3) + _varint(value)


def _bytes(field, value):
    value = value.encode() if isinstance(value, str) else value
    return _varint(field << 3 | 2) + _varint(len(value)) + value


def _attribute(name, value):
    if isinstance(value, str):
        return _bytes(1, name) + _bytes(4, value) + _number(20, 3)
    if isinstance(value, int):
        return _bytes(1, name) + _number(3, value) + _number(20, 2)
    return _bytes(1, name) + b''.join(_number(8, one) for one in value) + _number(20, 7)


def _value_info(name, shape):
    dims = b''.join(_bytes(1, _number(1, size)) for size in shape)
    return _bytes(1, name) + _bytes(2, _bytes(1, _number(1, 1) + _bytes(2, dims)))


class OnnxFile:
    """Collects nodes and weights in the order in which they are added. All numbers are float32."""

    OPSET = 10  # the last one in which Pad has its sizes as an attribute

    def __init__(self):
        self._graph = b''

    def node(self, kind, inputs, output, **attributes):
        message = b''.join(_bytes(1, name) for name in inputs) + _bytes(2, output) + _bytes(3, output) + _bytes(4, kind)
        self._graph += _bytes(1, message + b''.join(_bytes(5, _attribute(*one)) for one in attributes.items()))
        return output

    def weights(self, name, shape, values):
        dims = b''.join(_number(1, size) for size in shape)
        raw = struct.pack(f'<{len(values)}f', *values)
        self._graph += _bytes(5, dims + _number(2, 1) + _bytes(8, name) + _bytes(9, raw))
        return name

    def input(self, name, shape):
        self._graph += _bytes(11, _value_info(name, shape))

    def output(self, name, shape):
        self._graph += _bytes(12, _value_info(name, shape))

    def data(self, producer):
        opset = _bytes(1, '') + _number(2, self.OPSET)
        return _number(1, 5) + _bytes(2, producer) + _bytes(7, self._graph + _bytes(2, 'graph')) + _bytes(8, opset)
