#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a TensorFlow Lite network as ONNX: tflite_to_onnx.py MODEL.tflite MODEL.onnx

Takes the operators that the face mesh consists of, and refuses any other one. TensorFlow's tensors are ordered
image, row, column, channel (NHWC), ONNX' are image, channel, row, column (NCHW).
"""
import sys

from onnx_file import OnnxFile
from tflite_model import Model

ADD, CONV, DEPTHWISE_CONV, DEQUANTIZE, MAX_POOL, PAD, PRELU = 0, 3, 4, 6, 17, 34, 54
SAME = 0  # padding with which an output has ceil(input / stride) pixels


def to_nchw(four):
    return [four[0], four[3], four[1], four[2]]


class Converter:
    def __init__(self, model):
        self.tensors, self.operators, self.onnx = model.tensors, model.operators, OnnxFile()
        self.inputs, self.outputs = model.inputs, model.outputs

    def convert(self):
        for i in self.inputs:
            self.onnx.input(self.name(i), to_nchw(self.tensors[i].shape))
        for operator in self.operators:
            self.add(operator)
        for i in self.outputs:
            self.onnx.output(self.name(i), to_nchw(self.tensors[i].shape))
        return self.onnx.data('armature')

    def name(self, i):
        return f'{i}:{self.tensors[i].name}'

    def add(self, op):
        output = self.name(op.outputs[0])
        if op.code == DEQUANTIZE:  # of weights that are stored as float16
            self.tensors[op.outputs[0]].values = self.tensors[op.inputs[0]].values
        elif op.code == ADD:
            self.no_activation(op, 0)
            self.onnx.node('Add', [self.name(i) for i in op.inputs], output)
        elif op.code == CONV:
            self.no_activation(op, 3)
            self.no_dilation(op, 4)
            self.convolution(op, self.tensors[op.inputs[1]].shape, 1)
        elif op.code == DEPTHWISE_CONV:
            self.no_activation(op, 4)
            self.no_dilation(op, 5)
            _, rows, columns, channels = self.tensors[op.inputs[1]].shape
            # Weights are ordered row, column, channel: those of a convolution with one input, turned.
            self.convolution(op, [channels, rows, columns, 1], channels)
        elif op.code == MAX_POOL:
            self.no_activation(op, 5)
            size = [op.options.number(4, 'i'), op.options.number(3, 'i')]
            strides = [op.options.number(2, 'i'), op.options.number(1, 'i')]
            if any(self.padding(op, size, strides)):
                raise ValueError('a MAX_POOL_2D whose input has to be padded is not known')
            self.onnx.node('MaxPool', [self.name(op.inputs[0])], output, kernel_shape=size, strides=strides)
        elif op.code == PAD:
            sizes = self.tensors[op.inputs[1]].values  # before and after, of each dimension
            pads = to_nchw(sizes[0::2]) + to_nchw(sizes[1::2])
            self.onnx.node('Pad', [self.name(op.inputs[0])], output, mode='constant', pads=pads)
        elif op.code == PRELU:
            slopes = self.tensors[op.inputs[1]]
            weights = self.onnx.weights(output + '/slopes', [slopes.shape[-1], 1, 1], slopes.values)
            self.onnx.node('PRelu', [self.name(op.inputs[0]), weights], output)
        else:
            raise ValueError(f'the operator with number {op.code} is not known')

    def convolution(self, op, shape, groups):
        """The weights of `shape` (output, row, column, input), behind zeros around what they look at."""
        count, rows, columns, depth = shape
        values, output, source = self.tensors[op.inputs[1]].values, self.name(op.outputs[0]), self.name(op.inputs[0])
        if groups > 1:
            order = (p * count + c for c in range(count) for p in range(rows * columns))
        else:
            order = ((c * rows * columns + p) * depth + d
                     for c in range(count) for d in range(depth) for p in range(rows * columns))
        strides = [op.options.number(2, 'i'), op.options.number(1, 'i')]
        top, bottom, left, right = self.padding(op, [rows, columns], strides)
        if top or bottom or left or right:
            source = self.onnx.node('Pad', [source], output + '/padded', mode='constant',
                                    pads=[0, 0, top, left, 0, 0, bottom, right])
        weights = self.onnx.weights(output + '/weights', [count, depth, rows, columns], [values[i] for i in order])
        offsets = self.onnx.weights(output + '/offsets', [count], self.tensors[op.inputs[2]].values)
        self.onnx.node('Conv', [source, weights, offsets], output, kernel_shape=[rows, columns], strides=strides,
                       pads=[0, 0, 0, 0], group=groups)

    def padding(self, op, size, strides):
        """Zeros above, below, left and right; an odd one comes last."""
        if op.options.number(0, 'b') != SAME:
            return 0, 0, 0, 0
        sides = []
        for pixels, length, stride in zip(self.tensors[op.inputs[0]].shape[1:3], size, strides):
            total = max((-(-pixels // stride) - 1) * stride + length - pixels, 0)
            sides += [total // 2, total - total // 2]
        return tuple(sides)

    @staticmethod
    def no_activation(op, field):
        if op.options.number(field, 'b') != 0:
            raise ValueError('an activation inside of another operator is not known')

    @staticmethod
    def no_dilation(op, field):
        if any(op.options.number(field + i, 'i', 1) != 1 for i in (0, 1)):
            raise ValueError('a dilated convolution is not known')


def onnx_of(tflite):
    """The bytes of the ONNX file of the bytes of a TensorFlow Lite file; ValueError says why there are none."""
    return Converter(Model(tflite)).convert()


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        with open(sys.argv[1], 'rb') as source:
            converted = onnx_of(source.read())
        with open(sys.argv[2], 'wb') as target:
            target.write(converted)
    except (OSError, ValueError) as error:
        sys.exit(f'{sys.argv[1]}: {error}')
