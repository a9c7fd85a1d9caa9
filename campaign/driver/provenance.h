/* Facts about this program and machine, kept with every session of a store: version, commit (with its dirty flag),
 * compiler, flags, libraries, cpu model and class (bits are promised for one binary on one class), host, ranks, slots,
 * command line. Provenance, not identity. */
#ifndef CLAST_CAMPAIGN_DRIVER_PROVENANCE_H
#define CLAST_CAMPAIGN_DRIVER_PROVENANCE_H

/* A JSON object, malloc'd; NULL when memory is out. argv may be NULL. */
char *provenance_json(int ranks, int slots, int argc, char *const *argv);

#endif
