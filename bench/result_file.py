# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Files of results that grow, so that a stopped script can go on. Each belongs to one commit and one machine."""
import json


def load(output, about, fresh):
    """The results in a file, or None if it does not exist or is to be discarded. Refuses results of something else
    than `about`."""
    if fresh or not output.exists():
        return None
    results = json.loads(output.read_text())
    differing = [key for key, value in about.items() if results["about"].get(key) != value]
    if differing:
        raise SystemExit(f"error: {output} has results of another {' and '.join(differing)}; pass --fresh to discard them")
    return results


def save(output, results):
    part = output.with_name(output.name + ".part")
    part.write_text(json.dumps(results, indent=1, ensure_ascii=False) + "\n")
    part.replace(output)
