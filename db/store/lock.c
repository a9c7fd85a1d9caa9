/* The writer's lock on the store. */
#include "db/store/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/vfs.h>
#include <unistd.h>

/* SQLite locks bytes 0x40000000 to 0x400001ff, for any size of the file. */
static const off_t LOCK_BYTE = (off_t)1 << 62;

static const char *remedy_of(int code) {
  switch (code) {
  case ENOENT: return "Make its folder first.";
  case EISDIR: return "It is a folder: name a file.";
  case ENOTDIR: return "Part of the path is a file, not a folder.";
  case ENOSPC: return "Free some space.";
  case EROFS: return "The file system is read-only: copy the store elsewhere, or name another file.";
  default: return "Give yourself write permission on the file and its folder, or name another file.";
  }
}

status lock_take(const char *path, int *descriptor, bool *held, struct error *error) {
  *held = false;
  *descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (*descriptor < 0)
    return status_fail(error, STATUS_IO, "%s: cannot open the store for writing: %s. %s", path, strerror(errno),
                       remedy_of(errno));
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = LOCK_BYTE, .l_len = 1};
  if (fcntl(*descriptor, F_OFD_SETLK, &lock) == 0)
    return STATUS_OK;
  *held = errno == EACCES || errno == EAGAIN;
  status result = *held ? status_fail(error, STATUS_IO, "%s: another process is writing this store.", path)
                        : status_fail(error, STATUS_IO, "%s: cannot lock the store: %s. Put it on a local disk.", path,
                                      strerror(errno));
  close(*descriptor);
  *descriptor = -1;
  return result;
}

bool lock_is_held(const char *path) {
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (descriptor < 0)
    return false;
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = LOCK_BYTE, .l_len = 1};
  const bool held = fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  close(descriptor);
  return held;
}

const char *lock_network_file_system(int descriptor) {
  struct statfs file_system;
  if (fstatfs(descriptor, &file_system) != 0)
    return NULL;
  switch ((unsigned long)file_system.f_type & 0xffffffff) { /* man 2 statfs */
  case 0x6969: return "NFS";
  case 0x517b:
  case 0xff534d42:
  case 0xfe534d42: return "SMB/CIFS";
  case 0x0bd00bd0: return "Lustre";
  case 0x47504653: return "GPFS";
  case 0x00c36400: return "CephFS";
  case 0x65735546: return "FUSE";
  case 0x5346414f: return "AFS";
  case 0x01021997: return "9p";
  case 0x19830326: return "BeeGFS";
  default: return NULL;
  }
}
