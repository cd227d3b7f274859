"""Follows every link of the book: the file must be there, and the anchor in it."""

import html.parser
import pathlib
import sys
import urllib.parse

book = pathlib.Path(sys.argv[1]).resolve()


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.ids = [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if "id" in attributes:
            self.ids.add(attributes["id"])
        for name in ("href", "src"):
            if attributes.get(name):
                self.links.append(attributes[name])


pages = {path: Page(path) for path in book.rglob("*.html")}
broken, followed = [], 0
for path, page in pages.items():
    if path.name in ("404.html", "toc.html"):
        continue
    for link in page.links:
        parts = urllib.parse.urlsplit(link)
        if parts.scheme or parts.netloc:
            continue
        followed += 1
        target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
        if not target.exists():
            broken.append(f"{path.name}: {link}: no such file")
        elif parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].ids:
            broken.append(f"{path.name}: {link}: no such anchor")
print("\n".join(sorted(set(broken))))
if broken or followed < 1000:
    sys.exit(f"{len(set(broken))} broken links of {followed}")
print(f"{len(pages)} pages, {followed} links followed, none broken")
