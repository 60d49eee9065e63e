"""Methods under study: other ways to the library's results, to be measured against it by `precision` and `stability`.

Nothing in the library's numeric path calls them. May import the rooms above `studies`, and `simplifications`.
"""
