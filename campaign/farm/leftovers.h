/* Open MPI's ranks of one host talk through files in /dev/shm. Ranks and launchers that are killed leave theirs, 4 MB
 * of memory each, until the machine starts again. */
#ifndef CLAST_CAMPAIGN_FARM_LEFTOVERS_H
#define CLAST_CAMPAIGN_FARM_LEFTOVERS_H

/* Removes those of this user and this host that no process has mapped and that are older than a minute. */
void farm_leftovers_remove(void);

#endif
