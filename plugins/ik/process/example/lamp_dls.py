#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A solver for ik/process in plain Python: damped least squares from the seed, for the dental lamp.

A question per line on standard input, an answer per line on standard output, under the question's id:

    {"id":1,"position_m":[1.3,0.321,0.504],"direction":[0.894,-0.268,-0.358],"seed":[1,-1,0,0,0,0]}
    {"id":1,"status":"ok","solutions":[{"label":"from_seed","joints":[...]}]}
"""
import json
import math
import sys

# configs/robots/dental_lamp.yaml, standard Denavit-Hartenberg: d [m], a [m], alpha [deg].
TABLE = [(0.45257, 0.610, 0), (0.2515, 0, 90), (0, 0.600, 0), (0, 0.200, -90), (-0.200, 0.200, 90), (0, 0.080, 0)]
# Which independent joint moves each joint, and by what ratio: joint 4 turns back what joint 3 turns.
MOVED_BY = [(0, 1), (1, 1), (2, 1), (2, -1), (3, 1), (4, 1)]
SEED_OF = [0, 1, 2, 4, 5]  # the independent ones of all joints


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def forward(q):
    """Origin and z axis of every joint, then position and x axis of the tool."""
    x, y, z, p, joints = [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0], []
    for (d, a, alpha), (k, ratio) in zip(TABLE, MOVED_BY):
        joints.append((p, z))
        c, s = math.cos(ratio * q[k]), math.sin(ratio * q[k])
        x, y = [c * u + s * v for u, v in zip(x, y)], [c * v - s * u for u, v in zip(x, y)]
        p = [u + a * v + d * w for u, v, w in zip(p, x, z)]
        c, s = math.cos(math.radians(alpha)), math.sin(math.radians(alpha))
        y, z = [c * u + s * v for u, v in zip(y, z)], [c * v - s * u for u, v in zip(y, z)]
    return joints, p, x


def error_and_jacobian(q, position, direction):
    """What is missing, 3 numbers of position and 3 of direction, and how each joint changes it."""
    joints, p, x = forward(q)
    error = [g - h for g, h in zip(position + direction, p + x)]
    columns = [[0.0] * 6 for _ in q]
    for (origin, z), (k, ratio) in zip(joints, MOVED_BY):
        lever = [u - v for u, v in zip(p, origin)]
        for row, value in enumerate(cross(z, lever) + cross(z, x)):
            columns[k][row] += ratio * value
    return error, columns


def solved(matrix, right):
    """The solution of matrix * x = right by elimination; the matrix is positive definite."""
    n = len(right)
    rows = [row + [value] for row, value in zip(matrix, right)]
    for i in range(n):
        for j in range(i + 1, n):
            factor = rows[j][i] / rows[i][i]
            rows[j] = [u - factor * v for u, v in zip(rows[j], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][j] * x[j] for j in range(i + 1, n))) / rows[i][i]
    return x


def answer(question):
    if "direction" not in question:
        return {"status": "invalid_input", "reason": "this solver knows directions, not rotations"}
    length = math.hypot(*question["direction"])
    direction = [v / length for v in question["direction"]]
    q = [question["seed"][i] for i in SEED_OF]
    wanted = 0.1 * min(question.get("tolerance_m", 1e-9), question.get("tolerance_rad", 1e-9))
    for _ in range(min(200, question.get("max_iterations", 1000))):
        e, J = error_and_jacobian(q, question["position_m"], direction)
        size = math.sqrt(sum(v * v for v in e))
        if size <= wanted:
            joints = [ratio * q[k] for k, ratio in MOVED_BY]
            return {"status": "ok", "solutions": [{"label": "from_seed", "joints": joints}]}
        A = [[sum(u * v for u, v in zip(a, b)) for b in J] for a in J]
        for i in range(len(q)):
            A[i][i] += 0.01 * size * size + 1e-14
        step = solved(A, [sum(u * v for u, v in zip(a, e)) for a in J])
        q = [u + v for u, v in zip(q, step)]
    return {"status": "no_convergence", "residual": size, "reason": "the seed leads elsewhere"}


for line in sys.stdin:
    asked = json.loads(line)
    print(json.dumps({"id": asked.get("id"), **answer(asked)}), flush=True)
