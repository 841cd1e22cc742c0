#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A solver for the tests' gantry (joints: z, y, x of the tool) that has the fault that it is told.

    faulty_program.py FAULT FIRST LAST     the fault shows in these questions; the first of all is 1
"""
import json
import os
import signal
import sys
import time

fault = sys.argv[1]
first, last = int(sys.argv[2]), int(sys.argv[3])


def out(text):
    sys.stdout.write(text)
    sys.stdout.flush()


def good(question):
    return {"id": question["id"], "status": "ok",
            "solutions": [{"label": "only", "joints": question["position_m"][::-1]}]}


def changed(question, **changes):
    return json.dumps({**good(question), **changes}) + "\n"


def misbehave(question):
    x = question["position_m"][0]
    if fault == "exits":
        sys.exit("it has had enough")
    if fault == "crashes":
        os.kill(os.getpid(), signal.SIGSEGV)
    if fault == "sleeps":
        time.sleep(3600)
    if fault == "closes":
        os.close(1)
        time.sleep(3600)
    if fault == "garbage":
        out("Loading model...\n")
    if fault == "endless_line":
        while True:
            out("x" * 4096)
    if fault == "endless_errors":
        while True:
            sys.stderr.write("x" * 4095 + "\n")
    if fault == "half_a_line":
        out(changed(question).strip())
        sys.exit(0)
    if fault == "nan":
        out(changed(question, solutions=[{"joints": [float("nan"), 0, 0]}]))
    if fault == "few_joints":
        out(changed(question, solutions=[{"joints": [0, 0]}]))
    if fault == "other_id":
        out(changed(question, id=question["id"] - 1))
    if fault == "twice":
        out(2 * changed(question))
    if fault == "wrong":
        out(changed(question, solutions=[{"label": "only", "joints": [0, 0, x + 0.01]}]))
    if fault == "nothing_found":
        out(changed(question, solutions=[]))
    if fault == "refuses":
        out(changed(question, status="out_of_reach", solutions=[], beyond_reach_m=0.25,
                    reason="0.25 m beyond reach (the rail ends)"))
    if fault == "refuses_each":
        out(changed(question, status="no_convergence", solutions=[], reason=f"{x:.3f} is too far"))
    if fault == "many_labels":
        out(changed(question, solutions=[{"label": f"answer{question['id']}",
                                          "joints": question["position_m"][::-1]}]))
    if fault == "counts":
        out(changed(question, last_redundancy_rad=1 + question.get("last_redundancy_rad", 0)))
    if fault == "says_much":
        sys.stderr.write("working on it\nnot there yet\n" + "x" * 300000 + "\n")
        out(changed(question))


for line in sys.stdin:
    asked = json.loads(line)
    if first <= asked["id"] <= last:
        misbehave(asked)
    else:
        out(changed(asked))
