/* Programs that tests run beside glint, modules that their Python imports, and the Debian package that each comes in. Read by need.c, by programs.py and by ./dev,
   which installs the packages before it tests. What every Debian has (sh, awk, cmp) needs no row. */
PROGRAM("chromium-headless-shell", "chromium-headless-shell")
PROGRAM("exrheader", "openexr")
PROGRAM("exrinfo", "openexr")
PROGRAM("fish", "fish")
PROGRAM("idiff", "openimageio-tools")
PROGRAM("mandoc", "mandoc")
PROGRAM("jsonschema", "python3-jsonschema")
PROGRAM("mypy", "mypy")
PROGRAM("oiiotool", "openimageio-tools")
PROGRAM("readelf", "binutils")
PROGRAM("zsh", "zsh")
MODULE("matplotlib", "python3-matplotlib")
