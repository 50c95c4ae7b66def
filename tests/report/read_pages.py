"""A page of a record as a browser would read it."""

from html.parser import HTMLParser


class Page(HTMLParser):
    """Words, ids and what a browser would fetch."""

    def __init__(self, text):
        super().__init__()
        self.words, self.fetched, self.ids = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.ids += [given["id"]] if "id" in given else []
        source = given.get("src") or (given.get("href") if tag == "link" else None)
        if source and not source.startswith("data:"):
            self.fetched.append(source)

    def handle_data(self, data):
        self.words.append(data)


def told(folder):
    return " ".join(" ".join(Page((folder / "index.html").read_text()).words).split())
