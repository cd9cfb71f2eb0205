#!/usr/bin/env python3
"""Measures the meshes of one model with an independent verifier; prints one JSON object per mesh, as a list.

    tools/measure_one.py VERIFIER.py MODEL MESH=REPORT.json [MESH=REPORT.json ...]

A process of its own, because the other kernel may crash or hang on a model. tools/measure_models.py starts
it.
"""

from __future__ import annotations

import json
from pathlib import Path

from arguments import parser_of


def main() -> None:
    parser = parser_of(__doc__)
    parser.add_argument("verifier", metavar="VERIFIER.py")
    parser.add_argument("model")
    parser.add_argument("pairs", metavar="MESH=REPORT.json", nargs="+")
    args = parser.parse_args()
    # Imported here, so that --help needs no kernel.
    from measuring import load_verifier, measure

    verify = load_verifier(args.verifier)
    reference = verify.Reference(args.model)
    origins = verify.files[-1].entity_of_face()
    results = []
    for pair in args.pairs:
        mesh, report = pair.split("=")
        results.append(measure(verify, reference, origins, mesh, json.loads(Path(report).read_text())))
    print("\n" + json.dumps(results, default=float))


if __name__ == "__main__":
    main()
