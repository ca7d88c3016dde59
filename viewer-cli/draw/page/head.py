"""What stands around the document of every page: head.py STYLE.css... NOTICE ECHARTS.js SCRIPT.js... HEAD.html SCRIPTS.html. The policy
names the scripts by their digests, so that nothing else on the page runs, and lets nothing be fetched but pictures beside the page. With --live before them, the page may
ask its own server. ECharts is written between document and scripts by the program, which needs it for itself, too."""
import base64
import hashlib
import sys

BESIDE = " 'self' file:"  # a page that is opened as a file has no origin to be itself of
LIVE = " blob:; connect-src 'self'"

live = sys.argv[1] == "--live"
paths = sys.argv[1 + live:]
styles, scripts, outputs = ([p for p in paths if p.endswith(end)] for end in (".css", ".js", ".html"))
(notice,) = (p for p in paths if p not in styles + scripts + outputs)
head, rest = outputs


def read(path):
    with open(path, "rb") as file:
        return file.read()


digests = []
for path in scripts:
    text = read(path)
    # Browsers end a script at the first, and turn the second into the third before they take its digest.
    if b"</script" in text.lower() or b"<!--" in text or b"\r" in text:
        sys.exit(f"{path}: cannot stand in a page as it is")
    digests.append("'sha256-" + base64.b64encode(hashlib.sha256(text).digest()).decode() + "'")
policy = (f"default-src 'none'; script-src {' '.join(digests)}; style-src 'unsafe-inline'; img-src data:{LIVE if live else BESIDE}; "
          "base-uri 'none'; form-action 'none'")
with open(head, "w", encoding="utf-8") as file:
    file.write(f"""<!doctype html>
<!-- Charts by {" ".join(read(notice).decode().split())} Licensed under the Apache License, Version 2.0,
     https://www.apache.org/licenses/LICENSE-2.0 -->
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="referrer" content="no-referrer">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>glint</title>
<style>
{"".join(read(style).decode() for style in styles)}</style>
</head>
<body>
<noscript><p>This page builds itself by a script that it carries; it {"asks the program that it came from" if live else "fetches nothing"}.</p></noscript>
<script type="application/json" id="document">""")
with open(rest, "w", encoding="utf-8") as file:
    file.writelines(f"<script>{read(path).decode()}</script>\n" for path in scripts[1:])
    file.write("</body>\n</html>\n")
