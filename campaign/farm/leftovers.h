/* Open MPI's ranks on one host communicate through files in /dev/shm. Killed ranks and launchers leave their files
 * there, 4 MB of memory each, until the machine restarts. */
#ifndef CLAST_CAMPAIGN_FARM_LEFTOVERS_H
#define CLAST_CAMPAIGN_FARM_LEFTOVERS_H

/* Removes the files of this user and this host that no process has mapped and that are older than a minute. */
void farm_leftovers_remove(void);

#endif
