"""A report: one HTML file with the mechanism in motion, figures and tables.

report      `report` writes the file; the machines side by side with their case file
movement    drawings of the machines as data: strokes that move as rigid bodies, joints, arrows
tables      tables as text with units and significant digits, and every quantity at every angle
figures     interactive figures (Bokeh)
html        the page from its template, and its PDF by a browser

The folder `page` contains the template, its style and its script.
"""
