# SPDX-License-Identifier: Apache-2.0
"""Reads a TensorFlow Lite model: tensors with their values, and operators in the order in which they run.

The file is a FlatBuffer. A table begins with the distance back to a list of offsets, one for each of its fields, in
the order of TensorFlow's schema.fbs; an offset of 0 is a field that has its default.
"""
import struct


class Table:
    def __init__(self, data, at):
        self.data, self.at = data, at
        self.offsets = at - self._read('i', at)
        self.fields = (self._read('H', self.offsets) - 4) // 2

    def _read(self, form, at):
        return struct.unpack_from('<' + form, self.data, at)[0]

    def _place(self, field):
        offset = self._read('H', self.offsets + 4 + 2 * field) if field < self.fields else 0
        return self.at + offset if offset else None

    def _follow(self, field):
        place = self._place(field)
        return None if place is None else place + self._read('I', place)

    def number(self, field, form, default=0):
        place = self._place(field)
        return default if place is None else self._read(form, place)

    def numbers(self, field, form):
        start = self._follow(field)
        if start is None:
            return []
        return list(struct.unpack_from(f"<{self._read('I', start)}{form}", self.data, start + 4))

    def text(self, field):
        return bytes(self.numbers(field, 'B')).decode()

    def table(self, field):
        return Table(self.data, self._follow(field))

    def tables(self, field):
        start = self._follow(field)
        places = [] if start is None else range(start + 4, start + 4 + 4 * self._read('I', start), 4)
        return [Table(self.data, place + self._read('I', place)) for place in places]


class Tensor:
    FORMS = {0: 'f', 1: 'e', 2: 'i'}  # of the values, by the number of the type: float32, float16, int32

    def __init__(self, table, buffers):
        self.shape, self.name = table.numbers(0, 'i'), table.text(3)
        raw = bytes(buffers[table.number(2, 'I')].numbers(0, 'B'))
        self.values = None  # of what is computed
        if raw:
            form = self.FORMS[table.number(1, 'b')]
            self.values = struct.unpack(f'<{len(raw) // struct.calcsize(form)}{form}', raw)


class Operator:
    def __init__(self, table, codes):
        self.code = codes[table.number(0, 'I')]
        self.inputs, self.outputs = table.numbers(1, 'i'), table.numbers(2, 'i')
        self.options = table.table(4) if table.number(3, 'B') else None


class Model:
    """Of a file with one graph. Raises ValueError for bytes that are no such file."""

    def __init__(self, data):
        if data[4:8] != b'TFL3':
            raise ValueError('this is no TensorFlow Lite model: it does not begin with TFL3')
        try:
            model = Table(data, struct.unpack_from('<I', data)[0])
            # Numbers below 127 stand in a byte; newer files have them in a field of their own, too.
            codes = [max(code.number(0, 'b'), code.number(3, 'i')) for code in model.tables(1)]
            graph = model.tables(2)[0]
            buffers = model.tables(4)
            self.tensors = [Tensor(tensor, buffers) for tensor in graph.tables(0)]
            self.inputs, self.outputs = graph.numbers(1, 'i'), graph.numbers(2, 'i')
            self.operators = [Operator(operator, codes) for operator in graph.tables(3)]
        except (struct.error, IndexError, KeyError, TypeError) as error:
            raise ValueError(f'the TensorFlow Lite model is damaged ({error})') from error
