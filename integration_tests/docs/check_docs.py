#!/usr/bin/env python3
"""Checks the documents of a tree: links resolve, papers are identified, sentences are short, comments use plain words.

usage: check_docs.py ROOT       one line per problem, exit 1 if there is one
"""
import pathlib
import re
import subprocess
import sys

LONGEST_SENTENCE = 35  # words
READ_BY_PEOPLE = re.compile(r"(.*/)?README\.md|ARCHITECTURE\.md|CONTRIBUTING\.md|KNOWN_ISSUES\.md|docs/.*")
REFERENCES = "docs/references.md"
SOURCES = (".cpp", ".hpp", ".h", ".c", ".py", ".idl", ".cmake", ".yaml", ".md", ".txt")

# Documents that stood outside the project, and what took their place in docs/.
FOREIGN_DOCUMENT = re.compile(r"\b(methods|cli|[Dd]esign|dds-notes|compose-notes)\.md\b")
PAPER = re.compile(r"\bpapers? (00\d)((?:,? ?(?:and )?00\d)*)")
LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)")
COMMENT_OF = re.compile(r"^\s*(?://+!?|#|\*) Of\b|\S.*\s//+<? [Oo]f\b")
IGNORED = re.compile(r"build(-[^/]*)?/|(.*/)?__pycache__/")  # as .gitignore, where there is no git


def files_of(root):
    try:
        listed = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True, timeout=60, check=True)
        names = listed.stdout.splitlines()
    except (OSError, subprocess.CalledProcessError):
        names = [str(path.relative_to(root)) for path in pathlib.Path(root).rglob("*") if path.is_file()]
        names = [name for name in names if not IGNORED.match(name)]
    return [name for name in names if (pathlib.Path(root) / name).is_file()]


def anchor(heading):
    """As the usual renderers make it of a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors_of(text):
    return {anchor(line.lstrip("#")) for line in text.splitlines() if line.startswith("#")}


def prose_of(text):
    """The lines that are read as sentences: no tables, headings, fences or code."""
    fenced, lines = False, []
    for line in text.splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced and not line.startswith(("|", "#", "    ")):
            lines.append(line)
    return " ".join(lines)


def long_sentences(text):
    for sentence in re.sub(r"([.:;!?]) +", r"\1\n", prose_of(text)).splitlines():
        if len(sentence.split()) > LONGEST_SENTENCE:
            yield f"{len(sentence.split())} words: {sentence.strip()[:90]} ..."


def broken_links(root, name, text):
    here = (root / name).parent
    for target in LINK.findall(text):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, fragment = target.partition("#")
        file = (here / path).resolve() if path else (root / name).resolve()
        if not file.exists():
            yield f"link to {target}, which is not there"
        elif fragment and file.suffix == ".md" and fragment not in anchors_of(file.read_text()):
            yield f"link to {target}: there is no heading of that name"


def unknown_papers(text, known):
    for first, more in PAPER.findall(text):
        for paper in [first] + re.findall(r"00\d", more):
            if paper not in known:
                yield f"paper {paper} has no entry in {REFERENCES}"


def problems(root):
    root = pathlib.Path(root).resolve()
    references = root / REFERENCES
    known = set(re.findall(r"^## Paper (00\d)$", references.read_text(), re.MULTILINE)) if references.exists() else set()
    for name in files_of(root):
        path = root / name
        if not name.endswith(SOURCES) or name.startswith("integration_tests/docs/"):
            continue
        text = path.read_text(errors="replace")
        found = list(unknown_papers(text, known))
        if name.endswith(".md"):
            found += broken_links(root, name, text)
            if READ_BY_PEOPLE.fullmatch(name):
                found += long_sentences(text)
        else:
            found += [f"line {number}: a comment begins with 'Of'" for number, line in enumerate(text.splitlines(), 1) if COMMENT_OF.search(line)]
        if not name.startswith("docs/"):
            found += [f"cites {match}, which is no document of the project" for match in sorted(set(FOREIGN_DOCUMENT.findall(text)))]
        yield from (f"{name}: {problem}" for problem in found)


def main():
    if len(sys.argv) != 2:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    found = list(problems(sys.argv[1]))
    print("\n".join(found) if found else "documents: no problem")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
