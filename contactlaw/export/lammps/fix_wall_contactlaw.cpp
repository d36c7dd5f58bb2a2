/* Fix wall/contactlaw: LAMMPS's arrays on one side, a scene and the kernels of contactlaw_kernels.h on
 * the other. The scene is a file of contactlaw; nothing here knows what a wall is. */
#include "fix_wall_contactlaw.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "memory.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

typedef LAMMPS_NS::tagint contactlaw_tag;
#include "contactlaw_kernels.h"

using namespace LAMMPS_NS;
using namespace FixConst;

namespace
{

const int HEAD = sizeof(contactlaw_head) / sizeof(double);
const int CONTACT = sizeof(contactlaw_contact_row) / sizeof(double);
const int FRICTION = sizeof(contactlaw_friction_row) / sizeof(double);
const int NUMBERS = sizeof(contactlaw_load) / sizeof(double);
const int EVERY = 100; /* steps between looks at all beads */

/* The run that rows of the record name, one for all fixes: readers refuse files that another one has left. */
struct {
    long long number; /* microseconds from 1970 */
    double start;     /* by LAMMPS's clock [s] */
    int fixes;        /* that write a record now; the first one begins a run */
} run_of_rows;

/* What an error says, as in Python. */
std::string message(int code, double value = 0.0, double limit = 0.0)
{
    for (const auto &one : contactlaw_messages)
        if (one.code == code)
            return fmt::format(fmt::runtime(one.text), fmt::arg("value", value), fmt::arg("limit", limit),
                               fmt::arg("quotient", value > 0.0 ? limit / value : 0.0), fmt::arg("steps", CONTACTLAW_STEPS));
    return "";
}

}

struct FixWallContactlaw::Scene {
    std::vector<long long> blob; /* the arrays of the file */
    std::map<std::string, std::string> head;
    std::vector<std::string> walls;
    std::vector<contactlaw_load> loads;
    std::vector<double> shown, before;
    contactlaw_overlap found[CONTACTLAW_ROOM];
    contactlaw_impact_row impacts[CONTACTLAW_IMPACT_ROWS];
    contactlaw_status status = {};
    contactlaw_run run = {};
    double since = 0.0;
    long long written = 0;
    FILE *record = nullptr;

    double number(const char *name) { return std::stod(head[name]); }
    int count(const char *name) { return std::stoi(head[name]); }
    template <class T> T *at(const char *name)
    {
        return reinterpret_cast<T *>(reinterpret_cast<char *>(blob.data()) + std::stoll(head["at " + std::string(name)]));
    }

    contactlaw_wall_scene kernels()
    {
        return { { at<contactlaw_plate_row>("plate_rows"), count("types"), count("plates") },
                 { at<contactlaw_frame>("frames"), count("frames") },
                 { at<contactlaw_facet>("facets"), count("facets") },
                 { found, CONTACTLAW_ROOM }, { impacts, CONTACTLAW_IMPACT_ROWS }, { &status, 1 },
                 { loads.data(), int(loads.size()) },
                 number("friction"), number("softening"), number("parcel") };
    }
    contactlaw_wall_scene made; /* once, because reading numbers of texts takes time */
    int places = 0;
};

/* Read a scene on the first rank; on each, move the addresses in it to where it is. */
void FixWallContactlaw::read(const std::string &path)
{
    Scene &s = *scene_;
    std::string text;
    if (comm->me == 0) {
        std::ifstream file(path, std::ios::binary);
        std::stringstream all;
        all << file.rdbuf();
        text = all.str();
    }
    bigint size = bigint(text.size());
    MPI_Bcast(&size, 1, MPI_LMP_BIGINT, 0, world);
    text.resize(size_t(size));
    for (bigint at = 0; at < size; at += MAXSMALLINT / 2)
        MPI_Bcast(&text[size_t(at)], int(std::min<bigint>(size - at, MAXSMALLINT / 2)), MPI_CHAR, 0, world);
    const size_t end = text.find("\nend\n");
    std::stringstream lines(text.substr(0, end));
    std::string line, format;
    std::getline(lines, format);
    while (std::getline(lines, line)) {
        const size_t space = line.compare(0, 3, "at ") == 0 ? line.find(' ', 3) : line.find(' ');
        if (line.compare(0, 5, "wall ") == 0)
            s.walls.push_back(line.substr(5));
        else if (space != std::string::npos)
            s.head[line.substr(0, space)] = line.substr(space + 1);
    }
    if (end == std::string::npos || format != CONTACTLAW_FORMAT)
        error->all(FLERR, "Fix wall/contactlaw: {} is no scene of contactlaw, or cannot be read; 'contactlaw export "
                   "lammps' writes them", path);
    if (s.head["version"] + s.head["layout"] != CONTACTLAW_VERSION CONTACTLAW_LAYOUT)
        error->all(FLERR, "Fix wall/contactlaw: {} is of contactlaw {} ({}), and this fix of {} ({}); write both anew on "
                   "this machine", path, s.head["version"], s.head["layout"], CONTACTLAW_VERSION, CONTACTLAW_LAYOUT);
    const size_t begins = end + 5, bytes = size_t(std::stoll(s.head["bytes"]));
    if (text.size() != begins + bytes)
        error->all(FLERR, "Fix wall/contactlaw: {} is cut: it has {} bytes, and should have {}; copy it again", path,
                   text.size(), begins + bytes);
    s.blob.resize(bytes / sizeof(long long) + 1);
    std::memcpy(s.blob.data(), &text[begins], bytes);
    const long long *const moved = s.at<long long>("moved");
    for (int n = 0; n < s.count("moves"); ++n)
        s.blob[size_t(moved[n]) / sizeof(long long)] += (long long)(size_t) s.blob.data();
    s.loads.resize(s.walls.size());
    s.shown.assign(NUMBERS * s.walls.size(), 0.0), s.before = s.shown;
    s.places = s.count("contacts");
    s.made = s.kernels();
}

FixWallContactlaw::FixWallContactlaw(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), scene_(new Scene), history_(nullptr), columns_(0)
{
    contactlaw_run &run = scene_->run;
    const std::string units = update->unit_style;
    run.length = run.time = run.mass = 1.0, run.group = groupbit, run.accounts = 1;
    if (units == "cgs")
        run.length = 1e-2, run.mass = 1e-3;
    else if (units == "micro")
        run.length = run.time = 1e-6, run.mass = 1e-15;
    else if (units != "si")
        error->all(FLERR, "Fix wall/contactlaw needs units si, cgs or micro, not {}", units);
    if (!atom->radius_flag || !atom->rmass_flag || !atom->omega_flag || !atom->torque_flag)
        error->all(FLERR, "Fix wall/contactlaw needs atom_style sphere");
    if (domain->dimension != 3)
        error->all(FLERR, "Fix wall/contactlaw needs dimension 3");
    if (domain->triclinic)
        error->all(FLERR, "Fix wall/contactlaw: {}", message(CONTACTLAW_TRICLINIC));
    if (narg != 4 && !(narg == 6 && std::strcmp(arg[4], "record") == 0))
        error->all(FLERR, "Fix wall/contactlaw: expected a scene and 'record FILE', as in fix w all wall/contactlaw "
                   "drum.scene record hits.%.npy; 'contactlaw export lammps' writes scenes");
    read(arg[3]);
    if (scene_->count("types") != atom->ntypes)
        error->all(FLERR, "Fix wall/contactlaw: {} is for {} atom types, and the box has {}; write it for these", arg[3],
                   scene_->count("types"), atom->ntypes);
    run.base = run.start = scene_->since = time();
    run.tick = update->dt * run.time;
    columns_ = HEAD + scene_->places * (CONTACT + (scene_->made.friction > 0.0 ? FRICTION : 0));

    vector_flag = scalar_flag = energy_global_flag = 1, size_vector = int(scene_->shown.size());
    global_freq = 1, extscalar = 1, extvector = 0;
    peratom_flag = 1, size_peratom_cols = 0, peratom_freq = 1;
    restart_global = restart_peratom = 1, create_attribute = 1;
    maxexchange = columns_ + 2;
    grow_arrays(atom->nmax);
    atom->add_callback(Atom::GROW);
    atom->add_callback(Atom::RESTART);
    for (int i = 0; i < atom->nlocal; ++i)
        set_arrays(i);
    if (narg == 6)
        open(arg[5]);
}

FixWallContactlaw::~FixWallContactlaw()
{
    if (modify->get_fix_by_id(id))
        atom->delete_callback(id, Atom::GROW), atom->delete_callback(id, Atom::RESTART);
    if (scene_->record)
        --run_of_rows.fixes, count_rows(), std::fclose(scene_->record);
    memory->destroy(history_);
    memory->destroy(vector_atom);
}

int FixWallContactlaw::setmask()
{
    return POST_FORCE | MIN_POST_FORCE | POST_RUN;
}

void FixWallContactlaw::init()
{
    if (utils::strmatch(update->integrate_style, "^respa"))
        error->all(FLERR, "Fix wall/contactlaw: {}", message(CONTACTLAW_RESPA));
    for (Fix *const other : modify->get_fix_list())
        if (other->rigid_flag)
            error->all(FLERR, "Fix wall/contactlaw: not with fix {}: parts of rigid bodies answer with another mass; "
                       "contactlaw.engines.lammps.attach has them", other->id);
    double radius = 0.0, largest = 0.0;
    for (int i = 0; i < atom->nlocal; ++i)
        if (atom->mask[i] & groupbit)
            radius = std::max(radius, atom->radius[i] * scene_->run.length);
    MPI_Allreduce(&radius, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
    if (largest > scene_->number("largest"))
        error->all(FLERR, "Fix wall/contactlaw: the scene is for beads of up to {:g} m radius, and one has {:g} m; "
                   "write it with largest = {:g}", scene_->number("largest"), largest, largest);
}

void FixWallContactlaw::setup(int)
{
    /* `rerun` sets each of its frames up, without steps between them */
    if (update->laststep - update->firststep != update->nsteps || update->ntimestep != update->firststep)
        error->all(FLERR, "Fix wall/contactlaw: {}", message(CONTACTLAW_NO_STEPS));
    step(false);
}

void FixWallContactlaw::post_force(int)
{
    step(true);
}

void FixWallContactlaw::min_post_force(int)
{
    error->all(FLERR, "Fix wall/contactlaw: {}", message(CONTACTLAW_NO_STEPS));
}

/* LAMMPS's clock [s]. */
double FixWallContactlaw::time()
{
    return (update->atime + double(update->ntimestep - update->atimestep) * update->dt) * scene_->run.time;
}

void FixWallContactlaw::step(bool advancing)
{
    Scene &s = *scene_;
    contactlaw_run &run = s.run;
    const double dt = update->dt * run.time, before = run.before > 0.0 ? run.before : dt;
    if (advancing)
        run.before = dt;
    const double clock_of_walls = run.base + double(run.ticks) * run.tick;
    const bool looks = update->ntimestep % EVERY == 0;
    if (advancing && looks && clock_of_walls > s.since) { /* on all ranks */
        std::vector<double> all(s.shown.size());
        MPI_Allreduce(s.loads[0].force, all.data(), int(all.size()), MPI_DOUBLE, MPI_SUM, world);
        for (size_t n = 0; n < all.size(); ++n) {
            const double unit = run.mass * run.length / (run.time * run.time) * (n % NUMBERS > 2 ? run.length : 1.0)
                / (n % NUMBERS == NUMBERS - 1 ? run.time : 1.0);
            s.shown[n] = (all[n] - s.before[n]) / ((clock_of_walls - s.since) * unit);
        }
        s.before = all, s.since = clock_of_walls;
    }
    const int count = atom->nlocal;
    double *const none = nullptr;
    const auto start = [&](double **rows) { return count > 0 ? rows[0] : none; };
    const contactlaw_clock clock = { time(), dt, before, advancing };
    const contactlaw_beads beads = {
        count, atom->tag, atom->type, atom->mask, start(atom->x), start(atom->v), start(atom->omega), atom->radius,
        atom->rmass, start(atom->f), start(atom->torque), vector_atom, (long long)(size_t) start(history_),
        (long long) (columns_ * sizeof(double)), s.places };
    contactlaw_enclose(&run, clock, domain->boxlo, domain->boxhi, domain->periodicity);
    contactlaw_begin(s.made, { &run, 1 }, clock, beads, looks || !advancing);
    for (int first = 0; first < count && run.error == 0.0;) {
        first = contactlaw_step(s.made, { &run, 1 }, clock, beads, first);
        write_rows();
    }
    if (update->ntimestep % 10000 == 0)
        count_rows();
    if (run.error == 0.0)
        return;
    count_rows();
    const std::string bead = run.bead >= 0.0 ? fmt::format("bead {:.0f}", run.bead) : "";
    std::string wall = run.wall >= 0.0 ? s.walls[size_t(run.wall)] : "";
    wall = run.wall >= 0.0 ? " on wall " + (wall.empty() ? std::to_string(int(run.wall)) : wall) : "";
    error->one(FLERR, "Fix wall/contactlaw: {}{} at step {}: {}", bead, wall, update->ntimestep,
               message(int(run.error), run.value, run.limit));
}

void FixWallContactlaw::post_run()
{
    const contactlaw_status &status = scene_->status;
    if (status.overlap > CONTACTLAW_DEEPEST_OVERLAP)
        error->warning(FLERR, "Fix wall/contactlaw: an impact at {:.3g} m/s had an overlap of {:.2g} of the radius; take "
                       "less softening", status.speed, status.overlap);
    if (status.left_out > 0)
        error->warning(FLERR, "Fix wall/contactlaw: {} contacts beyond a bead's {} deepest had no force, one per step",
                       status.left_out, scene_->places);
    scene_->status.overlap = 0.0, scene_->status.left_out = 0;
    count_rows();
}

/* Begin a record: a file of numpy's, complete after each run. */
void FixWallContactlaw::open(std::string record)
{
    if (!utils::strmatch(record, "[.]npy$"))
        error->all(FLERR, "Fix wall/contactlaw: record: got {}; it must end in .npy", record);
    const size_t rank = record.find('%');
    if (rank == std::string::npos && comm->nprocs > 1)
        error->all(FLERR, "Fix wall/contactlaw: record: got {}; on several ranks it needs a %, as in hits.%.npy", record);
    if (rank != std::string::npos)
        record.replace(rank, 1, std::to_string(comm->me));
    scene_->record = std::fopen(record.c_str(), "wb");
    if (!scene_->record)
        error->one(FLERR, "Fix wall/contactlaw: record: {} cannot be written: {}", record, utils::getsyserror());
    std::fwrite(contactlaw_npy, 1, sizeof contactlaw_npy, scene_->record);
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    if (run_of_rows.fixes++ == 0)
        run_of_rows = { std::chrono::duration_cast<std::chrono::microseconds>(now).count(), time(), 1 };
    MPI_Bcast(&run_of_rows.number, 1, MPI_LONG_LONG, 0, world);
    count_rows();
}

void FixWallContactlaw::write_rows()
{
    Scene &s = *scene_;
    for (int n = 0; n < s.status.impacts; ++n)
        s.impacts[n].run = run_of_rows.number, s.impacts[n].run_start = run_of_rows.start;
    if (s.record && s.status.impacts > 0)
        s.written += (long long) std::fwrite(s.impacts, sizeof *s.impacts, size_t(s.status.impacts), s.record);
    s.status.impacts = 0;
}

/* Write into the head of the record how many rows it has. */
void FixWallContactlaw::count_rows()
{
    if (!scene_->record)
        return;
    std::fseek(scene_->record, CONTACTLAW_NPY_ROWS, SEEK_SET);
    std::fprintf(scene_->record, CONTACTLAW_NPY_DIGITS, scene_->written);
    std::fseek(scene_->record, 0, SEEK_END);
    std::fflush(scene_->record);
}

/* Energy that the beads have given to the walls since the fix began. */
double FixWallContactlaw::compute_scalar()
{
    double all = 0.0;
    MPI_Allreduce(&scene_->run.energy, &all, 1, MPI_DOUBLE, MPI_SUM, world);
    return all;
}

double FixWallContactlaw::compute_vector(int n)
{
    return scene_->shown[n];
}

void FixWallContactlaw::grow_arrays(int count)
{
    memory->grow(history_, count, columns_, "wall/contactlaw:history");
    memory->grow(vector_atom, count, "wall/contactlaw:restitution");
}

void FixWallContactlaw::copy_arrays(int from, int to, int)
{
    std::copy_n(history_[from], columns_, history_[to]);
    vector_atom[to] = vector_atom[from];
}

void FixWallContactlaw::set_arrays(int i)
{
    std::fill_n(history_[i], columns_, 0.0);
    vector_atom[i] = 0.0;
}

/* Only beads that touch a wall have more than a head. */
int FixWallContactlaw::size_restart(int i)
{
    return 2 + (reinterpret_cast<contactlaw_head *>(history_[i])->radius != 0.0 ? columns_ : HEAD);
}

int FixWallContactlaw::maxsize_restart()
{
    return columns_ + 2;
}

int FixWallContactlaw::pack_exchange(int i, double *to)
{
    to[0] = size_restart(i), to[1] = vector_atom[i];
    std::copy_n(history_[i], size_restart(i) - 2, to + 2);
    return size_restart(i);
}

int FixWallContactlaw::unpack_exchange(int i, double *from)
{
    set_arrays(i);
    std::copy_n(from + 2, int(*from) - 2, history_[i]);
    vector_atom[i] = from[1];
    return int(*from);
}

int FixWallContactlaw::pack_restart(int i, double *to)
{
    return pack_exchange(i, to);
}

void FixWallContactlaw::unpack_restart(int i, int nth)
{
    double *from = atom->extra[i];
    for (int n = 0; n < nth; ++n)
        from += int(*from);
    unpack_exchange(i, from);
}

void FixWallContactlaw::write_restart(FILE *file)
{
    const contactlaw_run &run = scene_->run;
    const double energy = compute_scalar();
    const double kept[] = { scene_->number("checksum"), run.base, run.tick, double(run.ticks), run.before, run.start, energy };
    const int bytes = sizeof kept;
    if (comm->me == 0)
        std::fwrite(&bytes, sizeof bytes, 1, file), std::fwrite(kept, 1, sizeof kept, file);
}

/* The walls go on from where they were. */
void FixWallContactlaw::restart(char *from)
{
    double kept[7];
    std::memcpy(kept, from, sizeof kept);
    if (*kept != scene_->number("checksum"))
        error->all(FLERR, "Fix wall/contactlaw: the restart file is of another scene; give fix {} the scene of the run before, "
                   "or the fix another ID", id);
    contactlaw_run &run = scene_->run;
    run.base = kept[1], run.tick = kept[2], run.ticks = (long long) kept[3], run.before = kept[4], run.start = kept[5];
    scene_->since = run.base + run.tick * kept[3], run.energy = comm->me == 0 ? kept[6] : 0.0;
}
