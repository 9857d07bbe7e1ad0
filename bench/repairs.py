"""The repairs that findings offer: correct projects whose text is damaged in one place, and whether
the first finding holds the text that was lost. A table by kind, and examples where it does not.

    python bench/repairs.py [mutants of each kind] [examples of each kind] [kind ...]

Mutants without a finding may be correct projects too: another number, a key with another value.
"""

from __future__ import annotations

import sys
import time
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.trust.text_mutations import TEXT_MUTATIONS, Repair, repairs
from tests.trust.unusual_projects import unusual_projects

EACH, EXAMPLES = 150, 0


def main(each: int = EACH, examples: int = EXAMPLES, kinds: Sequence[str] = ()) -> int:
    """Print the table as Markdown, then the examples."""
    begun = time.process_time()
    projects = sorted(unusual_projects().items())
    found: dict[str, list[tuple[str, Repair]]] = defaultdict(list)
    for offset, kind in enumerate(kinds or TEXT_MUTATIONS):
        for turn in range(each):
            name, files = projects[(turn + 31 * offset) % len(projects)]
            repair = repairs(files, kind, f"{kind} {name} {turn}")
            if repair is not None:
                found[kind].append((name, repair))
    print(
        "| what was changed | mutants | with a finding | with exactly one | names what was lost |"
    )
    print("| --- | ---: | ---: | ---: | ---: |")
    for kind, all_ in found.items():
        reported = [repair for _, repair in all_ if repair.findings]
        single = sum(len(repair.findings) == 1 for repair in reported)
        named = sum(repair.named for repair in reported)
        print(f"| {kind} | {len(all_)} | {len(reported)} | {single} | {named} |")
    print(f"\n{len(projects)} projects; {time.process_time() - begun:.0f} s of CPU")
    for kind, all_ in found.items():
        weak = [each for each in all_ if each[1].findings and not good(each[1])]
        for name, repair in weak[:examples]:
            print(f"\n{kind} in {name}, {repair.file}:{repair.mutant.line}: {repair.mutant.what}")
            for item in repair.findings:
                print(f"  {item.code} {item.span.line}: {item.message}\n    help: {item.help}")
    return 0


def good(repair: Repair) -> bool:
    return repair.named and len(repair.findings) == 1


if __name__ == "__main__":
    each, examples, *kinds = [*sys.argv[1:], *map(str, (EACH, EXAMPLES)[len(sys.argv) - 1 :])]
    sys.exit(main(int(each), int(examples), kinds))
