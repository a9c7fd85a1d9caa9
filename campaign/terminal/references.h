/* The papers that sources name, as entries with DOI. */
#ifndef CLAST_CAMPAIGN_TERMINAL_REFERENCES_H
#define CLAST_CAMPAIGN_TERMINAL_REFERENCES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

size_t references_count(void);
/* True when the source ("Benz & Asphaug 1995, eq. 6", "K99 table 1") names the paper. */
bool references_named(size_t index, const char *source);
/* The DOIs of all papers that the source names, with blanks between; empty when none has one. */
void references_doi(const char *source, char *text, size_t size);
/* One BibTeX entry. */
void references_bibtex(size_t index, FILE *out);

#endif
