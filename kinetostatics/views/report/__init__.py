"""Report: one HTML page with the moving mechanism, figures and tables; `page.html.j2` is its template.

May import errors, numbers to casefile, and `views`.
"""
