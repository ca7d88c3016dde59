"""Adds up the cases of the given build folders' test runs and prints the closing line of the suite."""
import os
import sys
import xml.etree.ElementTree as xml

passed = failed = skipped = 0
for folder in sys.argv[1:]:
    log = os.path.join(folder, "meson-logs", "testlog.junit.xml")
    if not os.path.exists(log):
        failed += 1
        print(f"{log}: missing, so the tests there did not run", file=sys.stderr)
        continue
    for case in xml.parse(log).iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
            print(f"failed: {folder}: {case.get('classname', '')} {case.get('name')}")
        elif case.find("skipped") is not None:
            skipped += 1
            print(f"skipped: {folder}: {case.get('name')}")
        else:
            passed += 1
if os.path.exists("build/style-ok"):
    passed += 1
else:
    failed += 1
    print("failed: style")
print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
sys.exit(1 if failed or not passed else 0)
