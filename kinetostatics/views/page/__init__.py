"""Scripts and styles of the pages: the report, explore in the browser and in a notebook."""
