/* Plain SQL for the statistics of points: any tool can run it without our functions. */
#ifndef CLAST_DB_STORE_VIEWS_STATISTICS_H
#define CLAST_DB_STORE_VIEWS_STATISTICS_H

#include <stddef.h>
#include <stdio.h>

/* The main results (engine/outcome.h), by rank: the columns of table run whose statistics the view `points` shows.
 * Returns how many. */
enum { VIEWS_STATISTICS_MAIN = 16 };
size_t views_statistics_main(const char *names[VIEWS_STATISTICS_MAIN]);

/* SQL that begins a query on the statistics of columns of table run, for every point and results_version: the table
 * expression `scatter` with point_id, results_version, n, the quantile t of views_statistics_student() and, for the
 * N-th name from 0, its mean mN and standard deviation dN. In C this is sample_summarise(); a test compares the two. */
void views_statistics_write(size_t count, const char *const *names, FILE *out);

/* SQL of a table expression with point_id, results_version and, for the N-th name from 0 (a column of the view runs),
 * the half width eN and the verdict vN of the view resolution; NULL if not studied. */
void views_statistics_resolution(size_t count, const char *const *names, FILE *out);

/* SQL for the two-sided 95 % quantile of Student's t with `degrees` (an SQL expression) of freedom: sample_student()
 * for tools without our functions, within 5e-6. */
void views_statistics_student(const char *degrees, FILE *out);

#endif
