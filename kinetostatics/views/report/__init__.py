"""A report: one HTML file in which the mechanism turns under the reader's hand, with figures and tables beside it.

making      the public door: what is reported, to a file
subject     what is reported: machines side by side, with what a case file says of them
movement    drawings of the machines as data: strokes that move as rigid bodies, joints, arrows
readings    every quantity at every angle that the reader can choose
tables      tables as text, with units and as many digits as are known
sections    which tables and figures a subject has
figures     figures to zoom and read (Bokeh)
html        all of it in the page, from its template
printing    the page as PDF, by a browser

The folder `page` holds the template, its style and its script.
"""
