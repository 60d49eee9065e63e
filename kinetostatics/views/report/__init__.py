"""Report: one HTML page with the moving mechanism, figures and tables; the folder `page` holds its template.

May import errors, numbers to casefile, and `views`.
"""
