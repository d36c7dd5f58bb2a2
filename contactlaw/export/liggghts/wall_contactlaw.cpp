// Adds the model contactlaw to walls and beads of LIGGGHTS, and its friction to walls, when loaded.
// A LIGGGHTS that is built with their headers among its sources does not need it.

#include "fix_wall_gran_base.h"
#include "modify.h"
#include "settings.h"

// pair_gran_base.h asks a fix that Debian's build has not, whose header needs this base.
namespace LAMMPS_NS
{
struct NoInsertStream : Fix {
    bool has_inserted() const { return false; }
};
}
#define FixInsertStream NoInsertStream
#include "pair_gran_base.h"
#undef FixInsertStream

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

template <int TANGENTIAL>
void add_pair()
{
    typedef GranStyle<CONTACTLAW, TANGENTIAL> Style;
    struct New {
        static PairStyles::IGranularPairStyle *pair(LAMMPS *lmp, PairGran *parent, int64_t hash)
        {
            return new PairStyles::Granular<ContactModel<Style> >(lmp, parent, hash);
        }
    };
    const int64_t hash = Style::HASHCODE;
    PairStyles::Factory::instance().addStyle("gran", hash, &New::pair);
}

struct Registration {
    Registration()
    {
        Factory::instance().addNormalModel("contactlaw", CONTACTLAW);
        Factory::instance().addTangentialModel("contactlaw", TANGENTIAL_CONTACTLAW);
        add_wall<TANGENTIAL_OFF>();
        add_wall<TANGENTIAL_HISTORY>();
        add_wall<TANGENTIAL_CONTACTLAW>();
        add_pair<TANGENTIAL_OFF>();
        add_pair<TANGENTIAL_HISTORY>();
    }
};

const Registration registration;

}
