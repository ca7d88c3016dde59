"""Adds up the cases of the given build folders' test runs and prints the closing line of the suite. A program that
fails although none of its cases did, such as one that was killed, is a failure of its own."""
import json
import os
import re
import sys
import xml.etree.ElementTree as xml

passed = failed = skipped = 0
for folder in sys.argv[1:]:
    logs = [os.path.join(folder, "meson-logs", name) for name in ("testlog.junit.xml", "testlog.json")]
    if not all(map(os.path.exists, logs)):
        failed += 1
        print(f"{logs[0]}: missing, so the tests there did not run", file=sys.stderr)
        continue
    blamed = set()
    for case in xml.parse(logs[0]).iter("testcase"):
        program = case.get("classname", "")
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
            # A program that ended before its first case counts as a case of its own name.
            blamed.update((program, case.get("name")))
            why = re.search("^Bail out! *(.*)", case.findtext("system-out", ""), re.M)
            print(f"failed: {folder}: {program} {case.get('name')}" + (f": {why[1]}" if why else ""))
        elif case.find("skipped") is not None:
            skipped += 1
            print(f"skipped: {folder}: {case.get('name')}")
        else:
            passed += 1
    with open(logs[1], encoding="utf-8") as lines:
        for program in map(json.loads, lines):
            if program["result"] not in ("OK", "SKIP") and not any(name.endswith(program["name"]) for name in blamed):
                failed += 1
                print(f"failed: {folder}: {program['name']} ended as {program['result']}, status {program['returncode']}")
if os.path.exists("build/style-ok"):
    passed += 1
else:
    failed += 1
    print("failed: style")
print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
sys.exit(1 if failed or not passed else 0)
