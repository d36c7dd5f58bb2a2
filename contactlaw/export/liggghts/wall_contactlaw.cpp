// Adds the models contactlaw, normal and tangential, to walls of LIGGGHTS as the library is loaded.
// A LIGGGHTS that is built with their headers among its sources does not need it.

#include "fix_wall_gran_base.h"

using namespace LIGGGHTS;
using namespace LIGGGHTS::ContactModels;

namespace
{

template <int TANGENTIAL>
void add_wall()
{
    typedef GranStyle<CONTACTLAW, TANGENTIAL> Style;
    struct New {
        static Walls::IGranularWall *wall(LAMMPS *lmp, FixWallGran *fix, int64_t hash)
        {
            return new Walls::Granular<ContactModel<Style> >(lmp, fix, hash);
        }
    };
    const int64_t hash = Style::HASHCODE;
    Walls::Factory::instance().addStyle("gran", hash, &New::wall);
}

// Walls alone: pair_gran_base.h does not compile with what Debian ships.
struct Registration {
    Registration()
    {
        Factory::instance().addNormalModel("contactlaw", CONTACTLAW);
        Factory::instance().addTangentialModel("contactlaw", TANGENTIAL_CONTACTLAW);
        add_wall<TANGENTIAL_OFF>();
        add_wall<TANGENTIAL_HISTORY>();
        add_wall<TANGENTIAL_CONTACTLAW>();
    }
};

const Registration registration;

}
