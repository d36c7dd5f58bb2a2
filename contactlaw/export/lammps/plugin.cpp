/* What LAMMPS asks of a plugin; lammpsplugin.h has the same, and is not installed everywhere. */
#include "fix_wall_contactlaw.h"

namespace
{

struct Plugin {
    const char *version, *style, *name, *info, *author;
    void *(*create)(LAMMPS_NS::LAMMPS *, int, char **);
    void *handle;
};

void *create(LAMMPS_NS::LAMMPS *lmp, int count, char **words)
{
    return new LAMMPS_NS::FixWallContactlaw(lmp, count, words);
}

}

extern "C" void lammpsplugin_init(void *lmp, void *handle, void *add)
{
    Plugin plugin = { LAMMPS_VERSION, "fix", "wall/contactlaw", "walls of contactlaw", "contactlaw", &create, handle };
    reinterpret_cast<void (*)(Plugin *, void *)>(add)(&plugin, lmp);
}
