/* Fix wall/contactlaw: LAMMPS's arrays and the words of an input script on one side, the kernels of
 * contactlaw_kernels.h on the other, which are in SI units. */
#include "fix_wall_contactlaw.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "memory.h"
#include "modify.h"
#include "region.h"
#include "update.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <vector>

#include "contactlaw_kernels.h"

using namespace LAMMPS_NS;
using namespace FixConst;
typedef std::array<double, 3> Vector;

namespace
{

/* What is kept of a bead, before its contacts: 0 for a bead that touches nothing. */
struct Head {
    double radius, mass, kind, softening, parcel; /* as it began to touch walls, in SI units */
    double restitution;                           /* of its last impact */
    double force[3], torque[3];                   /* of the walls in the last step, LAMMPS's units */
};

const int HEAD = sizeof(Head) / sizeof(double);
const int CONTACT = sizeof(contactlaw_contact_row) / sizeof(double);
const int FRICTION = sizeof(contactlaw_friction_row) / sizeof(double);
const int NUMBERS = sizeof(contactlaw_load) / sizeof(double);
const int EVERY = 100;    /* steps between looks at all beads */
const double SAME = 1e-6; /* largest relative change of a radius or a mass that counts as rounding */
const int TOO_FAST = -1, CHANGED = -2, CLASH = -3; /* errors of the fix; the kernels' are above 0 */

Vector operator-(Vector a, Vector b) { return { a[0] - b[0], a[1] - b[1], a[2] - b[2] }; }
Vector operator+(Vector a, Vector b) { return { a[0] + b[0], a[1] + b[1], a[2] + b[2] }; }
Vector operator*(double s, Vector a) { return { s * a[0], s * a[1], s * a[2] }; }
double dot(Vector a, Vector b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double size(Vector a) { return std::sqrt(dot(a, a)); }
Vector vector_of(const double *a) { return { a[0], a[1], a[2] }; }
void put(double *to, Vector from) { std::copy(from.begin(), from.end(), to); }

Vector cross(Vector a, Vector b)
{
    return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

/* Lowest and highest coordinates of points. */
struct Box {
    Vector low = { HUGE_VAL, HUGE_VAL, HUGE_VAL }, high = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
    void add(Vector at)
    {
        for (int k = 0; k < 3; ++k)
            low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    }
    Vector size() const { return high - low; }
};

/* Things that pairs join, directly or through others, have the same root. */
struct Joined {
    std::vector<int> part;
    explicit Joined(size_t count) : part(count) { std::iota(part.begin(), part.end(), 0); }
    int root(int n)
    {
        while (part[n] != n)
            n = part[n] = part[part[n]];
        return n;
    }
    void join(int a, int b) { part[root(a)] = root(b); }
};

/* The run that rows of the record name, one for all fixes: readers refuse files that another one has left. */
struct {
    long long number; /* microseconds from 1970 */
    double start;     /* by LAMMPS's clock [s] */
    int fixes;        /* that write a record now; the first one begins a run */
} run;

struct Wall {
    double thickness = HUGE_VAL;
    int plate = 0, edges = 0, frame = -1; /* number of the material, kind of the edges from 1 */
    Region *region = nullptr;
    std::string name;  /* of the region */
    double axis = 1.0; /* length of its axis of rotation */
    std::vector<Vector> corners; /* three of each triangle, or four of a rectangle [m] */
    bool mesh = false;
    double scale = 1.0;
    contactlaw_frame motion = {};
};

struct Grid {
    std::vector<long long> starts;
    std::vector<int> entries;
    std::vector<unsigned char> busy;
};

std::vector<Vector> corners_of(const contactlaw_facet &one)
{
    const Vector a = vector_of(one.a), b = vector_of(one.b), here = vector_of(one.corner);
    if (one.kind == contactlaw_TRIANGLE)
        return { here, here + a, here + b };
    const Vector side = one.length_a * a, other = one.length_b * b;
    return { here, here + side, here + side + other, here + other };
}

/* Triangles of a file of STL, text or binary. */
std::vector<Vector> read_stl(const std::string &path)
{
    std::ifstream file(path, std::ios::binary);
    std::stringstream all;
    all << file.rdbuf();
    const std::string text = all.str();
    std::vector<Vector> found;
    uint32_t count = 0;
    if (text.size() >= 84)
        std::memcpy(&count, text.data() + 80, 4);
    if (text.size() >= 84 && text.size() >= 84 + 50 * size_t(count) && count > 0) {
        for (size_t n = 0; n < 3 * size_t(count); ++n) {
            float at[3];
            std::memcpy(at, text.data() + 84 + 50 * (n / 3) + 12 + 12 * (n % 3), 12);
            found.push_back({ at[0], at[1], at[2] });
        }
        return found;
    }
    std::string word;
    for (Vector at; all >> word;)
        if ((word == "vertex" || word == "VERTEX") && all >> at[0] >> at[1] >> at[2])
            found.push_back(at);
    found.resize(all.eof() ? found.size() / 3 * 3 : 0); /* a number that is none has stopped it */
    return found;
}

/* LAMMPS is asked once for all walls of a region around a point. */
struct {
    Region *region;
    contactlaw_vector at;
    double reach;
    int count;
} asked;

Region *region_of(const contactlaw_facet &facet) { return reinterpret_cast<Region *>(size_t(facet.edges)); }

const Region::Contact *region_contact(contactlaw_facet *facet, contactlaw_vector p, double r)
{
    Region *const region = region_of(*facet);
    const double per = 1.0 / facet->length_a, reach = 2.0 * r * per;
    if (asked.region != region || asked.at.f0 != p.f0 || asked.at.f1 != p.f1
        || asked.at.f2 != p.f2 || asked.reach != reach) {
        const double x = p.f0 * per, y = p.f1 * per, z = p.f2 * per;
        asked = { region, p, reach, region->match(x, y, z) ? region->surface(x, y, z, reach) : 0 };
    }
    for (int n = 0; n < asked.count; ++n)
        if (region->contact[n].iwall == facet->triangle)
            return region->contact + n;
    return nullptr;
}

}

static contactlaw_touch contactlaw_region_touch(contactlaw_facet *facet, contactlaw_vector p, double r)
{
    const Region::Contact *const one = region_contact(facet, p, r);
    if (!one)
        return { -HUGE_VAL, HUGE_VAL, 0.0, 0.0, 1.0, 1 };
    const double far = one->r * facet->length_a, per = 1.0 / one->r;
    return { r - far, far, one->delx * per, one->dely * per, one->delz * per, 1 };
}

/* LAMMPS gives the radius of a sphere, and twice that of a cylinder or a cone; below 0 inside. */
static contactlaw_bend contactlaw_region_bend(contactlaw_facet *facet, contactlaw_vector p, double r)
{
    const Region::Contact *const one = region_contact(facet, p, r);
    if (!one || one->radius == 0.0)
        return { 1.0, 0.0, 0.0 };
    const double curvature = 1.0 / (one->radius * facet->length_a);
    if (std::strcmp(region_of(*facet)->style, "sphere") == 0)
        return { 1.0, curvature, curvature };
    return { 1.0, 2.0 * curvature, 0.0 };
}

struct FixWallContactlaw::Scene {
    double length = 1.0, time = 1.0, mass = 1.0; /* LAMMPS's units, in SI */
    double friction = 0.0, softening = 1.0, parcel = 1.0;
    std::vector<Wall> walls;
    std::vector<int> beads; /* material of each atom type */
    std::vector<contactlaw_plate_row> rows;
    std::vector<contactlaw_frame> frames;
    std::vector<contactlaw_facet> facets;
    std::vector<contactlaw_edge> edges;
    std::vector<Grid> grids;
    std::vector<contactlaw_load> loads;
    std::vector<double> pressed, shown, before;
    contactlaw_overlap found[CONTACTLAW_ROOM];
    contactlaw_impact_row impacts[4 * CONTACTLAW_MOST_CONTACTS];
    contactlaw_status status = {};
    double base = 0.0, tick = 0.0, last = 0.0, since = 0.0, energy = 0.0, largest = 0.0;
    long long ticks = 0, written = 0;
    int places = 0;
    FILE *record = nullptr;

    contactlaw_wall_scene kernels()
    {
        const int types = int(beads.size());
        return { { rows.data(), types, int(walls.size()) }, { frames.data(), int(frames.size()) },
                 { facets.data(), int(facets.size()) }, { found, CONTACTLAW_ROOM },
                 { impacts, 4 * CONTACTLAW_MOST_CONTACTS }, { &status, 1 }, { loads.data(), int(loads.size()) },
                 pressed.data(), friction, softening, parcel };
    }

    void add_facets(int wall);
    void add_edges(int wall, size_t first);
    void fill_grid(int frame);
    void follow_regions(bigint, double);
};

void FixWallContactlaw::Scene::add_facets(int number)
{
    Wall &wall = walls[number];
    const size_t first = facets.size(), step = wall.mesh ? 3 : 4;
    for (int n = 0; wall.region && n < wall.region->cmax; ++n) {
        contactlaw_facet one = {};
        one.kind = contactlaw_REGION, one.triangle = n, one.edges = (long long)(size_t) wall.region;
        one.length_a = length;
        one.plate_row = one.wall = number, one.frame = wall.frame;
        facets.push_back(one);
    }
    std::set<std::vector<Vector>> seen; /* a triangle that is there twice would have no edges */
    for (size_t n = 0; n + step <= wall.corners.size(); n += step) {
        std::vector<Vector> corners(&wall.corners[n], &wall.corners[n] + step);
        std::sort(corners.begin(), corners.end());
        contactlaw_facet one = {};
        const Vector here = wall.corners[n], a = wall.corners[n + 1] - here;
        const Vector b = wall.corners[n + step - 1] - here, normal = cross(a, b);
        if (!(size(normal) > 0.0) || !seen.insert(corners).second)
            continue;
        one.kind = wall.mesh ? contactlaw_TRIANGLE : contactlaw_RECTANGLE;
        one.triangle = wall.mesh ? (long long)(n / step) : -1;
        put(one.corner, here), put(one.normal, (1.0 / size(normal)) * normal);
        one.length_a = size(a), one.length_b = size(b), one.between = dot(a, b);
        put(one.a, wall.mesh ? a : (1.0 / one.length_a) * a);
        put(one.b, wall.mesh ? b : (1.0 / one.length_b) * b);
        one.plate_row = one.wall = number, one.frame = wall.frame;
        facets.push_back(one);
    }
    if (wall.edges > 0 && !wall.region)
        add_edges(number, first);
}

/* Sides that one facet alone has are edges of the plate; around a hole they have its radius. */
void FixWallContactlaw::Scene::add_edges(int number, size_t first)
{
    std::vector<std::vector<Vector>> all;
    Box whole;
    for (size_t n = first; n < facets.size(); ++n) {
        all.push_back(corners_of(facets[n]));
        std::for_each(all.back().begin(), all.back().end(), [&](Vector one) { whole.add(one); });
    }
    const Vector wide = whole.size();
    /* Vertices that round to the same steps are one. Round coordinates must not lie between two steps. */
    const double step = 0.8647e-6 * std::max({ wide[0], wide[1], wide[2], 1e-300 });
    std::map<std::array<long long, 3>, int> vertices;
    std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> sides; /* facet and corner */
    for (size_t n = 0; n < all.size(); ++n)
        for (size_t k = 0; k < all[n].size(); ++k) {
            std::pair<int, int> side;
            for (int *end : { &side.first, &side.second }) {
                const Vector &at = all[n][(k + (end == &side.second)) % all[n].size()];
                std::array<long long, 3> key;
                for (int m = 0; m < 3; ++m)
                    key[m] = std::llrint(at[m] / step);
                *end = vertices.emplace(key, int(vertices.size())).first->second;
            }
            if (side.second < side.first)
                std::swap(side.first, side.second);
            sides[side].push_back({ int(n), int(k) });
        }
    Joined smooth(all.size()), line(vertices.size());
    for (const auto &[ends, of] : sides) {
        for (size_t n = 1; n < of.size(); ++n) {
            const auto &one = facets[first + of[n - 1].first], &other = facets[first + of[n].first];
            if (std::fabs(dot(vector_of(one.normal), vector_of(other.normal))) > contactlaw_SMOOTH)
                smooth.join(of[n - 1].first, of[n].first);
        }
        if (of.size() == 1)
            line.join(ends.first, ends.second);
    }
    struct Around {
        double length = 0.0, outside = 0.0;
        Vector centre = {};
    };
    std::map<int, Around> around;
    std::vector<std::pair<contactlaw_edge, int>> found;
    for (const auto &[ends, of] : sides)
        if (of.size() == 1) {
            const auto &corners = all[of[0].first];
            const Vector a = corners[of[0].second], b = corners[(of[0].second + 1) % corners.size()];
            contactlaw_edge one = {};
            put(one.start, a), put(one.along, b - a);
            one.square = dot(b - a, b - a), one.kind = walls[number].edges - 1;
            one.facet = of[0].first, one.hole = HUGE_VAL;
            found.push_back({ one, line.root(ends.first) });
            Around &rim = around[found.back().second];
            rim.length += size(b - a), rim.centre = rim.centre + 0.5 * size(b - a) * (a + b);
        }
    for (const auto &[one, which] : found) {
        Around &rim = around[which];
        Vector middle = vector_of(one.start) + 0.5 * vector_of(one.along), sheet = {};
        for (const Vector &corner : all[one.facet])
            sheet = sheet + (1.0 / double(all[one.facet].size())) * corner;
        const Vector out = middle - (1.0 / rim.length) * rim.centre, in = sheet - middle;
        rim.outside += std::sqrt(one.square) * dot(out, in) / std::max(size(out) * size(in), 1e-300);
    }
    for (auto &[one, which] : found)
        if (around[which].outside > 0.5 * around[which].length)
            one.hole = around[which].length / (2.0 * M_PI);
    for (size_t n = 0; n < all.size(); ++n) { /* those that may be nearest to a point of a facet */
        contactlaw_facet &facet = facets[first + n];
        Box box;
        std::for_each(all[n].begin(), all[n].end(), [&](Vector one) { box.add(one); });
        const Vector middle = 0.5 * (box.low + box.high);
        const double diagonal = size(box.size());
        std::vector<std::pair<double, const contactlaw_edge *>> near;
        double least = HUGE_VAL;
        for (const auto &[one, which] : found) {
            if (smooth.root(int(one.facet)) != smooth.root(int(n)))
                continue;
            const Vector start = vector_of(one.start), along = vector_of(one.along);
            const double share = dot(middle - start, along) / one.square;
            const double far = size(middle - start - std::clamp(share, 0.0, 1.0) * along);
            near.push_back({ far, &one }), least = std::min(least, far);
        }
        facet.edges = (long long) edges.size(); /* an address, when all are there */
        for (const auto &[far, one] : near)
            if (far <= least + diagonal)
                edges.push_back(*one), ++facet.edge_count;
        facet.clear = least - 0.5 * diagonal;
    }
}

/* Lists of the facets that a bead may touch in each cell of a grid. */
void FixWallContactlaw::Scene::fill_grid(int number)
{
    const int most = 1 << 20;
    contactlaw_frame &frame = frames[number];
    Grid &grid = grids[number];
    std::vector<Box> boxes;
    std::vector<int> own;
    std::vector<double> extents;
    Box whole;
    for (size_t n = 0; n < facets.size(); ++n) {
        if (facets[n].frame != number)
            continue;
        Box box = { { -1e30, -1e30, -1e30 }, { 1e30, 1e30, 1e30 } };
        if (facets[n].kind != contactlaw_REGION) {
            box = Box();
            for (const Vector &one : corners_of(facets[n]))
                box.add(one);
        }
        whole.add(box.low), whole.add(box.high);
        own.push_back(int(n)), boxes.push_back(box), extents.push_back(size(box.size()));
    }
    const bool region = facets[own[0]].kind == contactlaw_REGION;
    std::nth_element(extents.begin(), extents.begin() + extents.size() / 2, extents.end());
    frame.reach = CONTACTLAW_MARGIN * (largest > 0.0 ? largest : 0.5 * extents[extents.size() / 2]);
    put(frame.low, whole.low), put(frame.high, whole.high);
    const Vector more = { frame.reach, frame.reach, frame.reach }, origin = whole.low - more;
    const Vector wide = whole.high + more - origin;
    double volume = wide[0] * wide[1] * wide[2], count = 0.0;
    double cell = std::max(frame.reach, std::cbrt(volume / most));
    for (; !region; cell *= 1.1) {
        count = 1.0;
        for (int k = 0; k < 3; ++k)
            frame.cells[k] = (long long) std::max(std::ceil(wide[k] / cell), 1.0), count *= double(frame.cells[k]);
        if (count <= 2.0 * most)
            break;
    }
    frame.per_length = 1.0 / cell;
    if (region) { /* one cell for all of space: the region itself says what is near */
        frame.per_length = 0.0, frame.reach = HUGE_VAL, count = 1.0;
        std::fill(frame.cells, frame.cells + 3, 1);
    }
    put(frame.origin, origin);
    std::vector<std::vector<int>> lists(static_cast<size_t>(count));
    const double within = frame.reach + 0.5 * std::sqrt(3.0) * cell;
    for (size_t n = 0; n < own.size(); ++n) {
        int from[3], to[3];
        for (int k = 0; k < 3; ++k) {
            const double per = frame.per_length, first = (boxes[n].low[k] - frame.reach - origin[k]) * per;
            const double last = (boxes[n].high[k] + frame.reach - origin[k]) * per;
            from[k] = region ? 0 : std::max(int(std::floor(first)), 0);
            to[k] = region ? 0 : std::min(int(std::floor(last)), int(frame.cells[k]) - 1);
        }
        for (int i = from[0]; i <= to[0]; ++i)
            for (int j = from[1]; j <= to[1]; ++j)
                for (int k = from[2]; k <= to[2]; ++k) {
                    const contactlaw_vector middle = { origin[0] + (i + 0.5) * cell,
                                                       origin[1] + (j + 0.5) * cell,
                                                       origin[2] + (k + 0.5) * cell };
                    if (region || contactlaw_on_facet(&facets[own[n]], middle, within).x >= 0.0)
                        lists[(i * frame.cells[1] + j) * frame.cells[2] + k].push_back(own[n]);
                }
    }
    grid.starts.assign(1, 0), grid.entries.clear(), grid.busy.assign(lists.size() / 8 + 1, 0);
    for (size_t n = 0; n < lists.size(); ++n) {
        grid.entries.insert(grid.entries.end(), lists[n].begin(), lists[n].end());
        grid.starts.push_back((long long) grid.entries.size());
        if (!lists[n].empty())
            grid.busy[n >> 3] |= (unsigned char) (1 << (n & 7));
    }
    frame.starts = (long long)(size_t) grid.starts.data();
    frame.entries = (long long)(size_t) grid.entries.data();
    frame.busy = (long long)(size_t) grid.busy.data();
    frame.entry_count = (long long) grid.entries.size(), frame.cell_count = (long long) lists.size();
}

/* Frames of regions have the velocity that LAMMPS moves them with. */
void FixWallContactlaw::Scene::follow_regions(bigint step, double dt)
{
    asked.region = nullptr;
    for (Wall &wall : walls) {
        Region *const region = wall.region;
        if (!region)
            continue;
        region->prematch();
        if (!region->dynamic_check())
            continue;
        const bool first = region->vel_timestep != step; /* else another fix has asked in this step */
        const double turned = region->theta - region->prev[3];
        region->set_velocity();
        contactlaw_frame &frame = frames[wall.frame];
        frame.moves = 1;
        std::fill_n(frame.turn, 9, 0.0);
        for (int k = 0; k < 3; ++k) {
            frame.turn[4 * k] = 1.0;
            frame.hub[k] = region->rpoint[k] * length;
            frame.rate[k] = frame.half_rate[k] = region->moveflag ? region->v[k] * length / time : 0.0;
        }
        const Vector omega = vector_of(region->omega);
        if (first && turned != 0.0 && size(omega) > 0.0) /* LAMMPS's is that times the axis as it was given */
            wall.axis = size(omega) / time * dt / std::fabs(turned);
        frame.spin = region->rotateflag ? size(omega) / (time * wall.axis) : 0.0;
        if (frame.spin > 0.0)
            put(frame.axis, (1.0 / size(omega)) * omega);
    }
}

FixWallContactlaw::FixWallContactlaw(LAMMPS *lmp, int narg, char **arg)
    : Fix(lmp, narg, arg), scene_(new Scene), history_(nullptr), columns_(0)
{
    Scene &s = *scene_;
    const std::string units = update->unit_style;
    if (units == "cgs")
        s.length = 1e-2, s.mass = 1e-3;
    else if (units == "micro")
        s.length = s.time = 1e-6, s.mass = 1e-15;
    else if (units != "si")
        error->all(FLERR, "Fix wall/contactlaw needs units si, cgs or micro, not {}", units);
    if (!atom->radius_flag || !atom->rmass_flag || !atom->omega_flag || !atom->torque_flag)
        error->all(FLERR, "Fix wall/contactlaw needs atom_style sphere");
    if (domain->dimension != 3)
        error->all(FLERR, "Fix wall/contactlaw needs dimension 3");

    int at = 3;
    const auto given = [&](const char *what) {
        if (at >= narg)
            error->all(FLERR, "Fix wall/contactlaw: {} is missing at the end", what);
        return std::string(arg[at++]);
    };
    const auto number = [&](const char *what, double least = -HUGE_VAL) {
        const std::string word = given(what);
        const double found = utils::numeric(FLERR, word, false, lmp);
        if (!(found >= least && std::fabs(found) < 1e30))
            error->all(FLERR, "Fix wall/contactlaw: {}: got {}; must be finite and at least {:g}", what, word, least);
        return found;
    };
    const auto vector = [&](const char *what, double unit) {
        Vector found;
        for (double &one : found)
            one = unit * number(what);
        return found;
    };
    const auto known = [&](const char *what, const std::string &word, const char *const *names, int count) {
        for (int n = 0; n < count; ++n)
            if (word == names[n])
                return n;
        std::string all;
        for (int n = 0; n < count; ++n)
            all += (n ? ", " : "") + std::string(names[n]);
        error->all(FLERR, "Fix wall/contactlaw: {}: got {}; must be one of {}", what, word, all);
    };
    s.beads.assign(atom->ntypes, 0);
    std::string record;
    while (at < narg) {
        const std::string word = given("a word");
        if (word == "plane" || word == "plate" || word == "mesh" || word == "region") {
            Wall wall;
            if (word == "plate") {
                const Vector corner = vector("corner of plate", s.length);
                const Vector a = vector("edge of plate", s.length), b = vector("edge of plate", s.length);
                if (!(size(cross(a, b)) > 0.0 && std::fabs(dot(a, b)) <= 1e-9 * size(a) * size(b)))
                    error->all(FLERR, "Fix wall/contactlaw: plate: its two edges must be at a right angle");
                wall.corners = { corner, corner + a, corner + a + b, corner + b };
            } else if (word == "plane") { /* a plate that is larger than the box */
                const Vector point = vector("point of plane", s.length), n = vector("normal of plane", 1.0);
                const bool upright = std::fabs(n[2]) > 0.5 * size(n);
                Vector a = cross(n, upright ? Vector{ 1.0, 0.0, 0.0 } : Vector{ 0.0, 0.0, 1.0 }), b = cross(n, a);
                if (!(size(n) > 0.0))
                    error->all(FLERR, "Fix wall/contactlaw: plane: its normal must have a direction");
                const Vector low = vector_of(domain->boxlo), high = vector_of(domain->boxhi);
                const double wide = 4.0 * s.length * size(high - low);
                a = (wide / size(a)) * a, b = (wide / size(b)) * b;
                const Vector middle = 0.5 * s.length * (low + high), far = (dot(point - middle, n) / dot(n, n)) * n;
                const Vector corner = middle + far - 0.5 * (a + b);
                wall.corners = { corner, corner + a, corner + a + b, corner + b };
            } else if (word == "mesh") {
                const std::string path = given("file of mesh");
                std::vector<Vector> &all = wall.corners;
                if (comm->me == 0)
                    all = read_stl(path);
                int count = int(all.size());
                MPI_Bcast(&count, 1, MPI_INT, 0, world);
                all.resize(size_t(count));
                MPI_Bcast(all.data(), 3 * count, MPI_DOUBLE, 0, world);
                if (count == 0)
                    error->all(FLERR, "Fix wall/contactlaw: mesh: {}: no triangles, or not all are numbers; give a file of STL", path);
                wall.mesh = true, wall.scale = s.length;
            } else {
                wall.name = given("ID of region");
                wall.region = domain->get_region_by_id(wall.name);
                const Region *const one = wall.region;
                if (!one || one->varshape || (wall.region->dynamic_check() && !one->moveflag && !one->rotateflag))
                    error->all(FLERR, "Fix wall/contactlaw: region: there is no {}, or its shape changes or parts move", wall.name);
            }
            s.walls.push_back(wall);
            continue;
        }
        if (word == "friction") {
            s.friction = number("friction", 0.0);
        } else if (word == "softening") {
            s.softening = number("softening", 1.0);
        } else if (word == "parcel") {
            s.parcel = number("parcel", 1.0);
        } else if (word == "record") {
            record = given("file of record");
        } else if (word == "beads") {
            const int type = utils::inumeric(FLERR, given("atom type of beads"), false, lmp);
            if (type < 1 || type > atom->ntypes)
                error->all(FLERR, "Fix wall/contactlaw: beads: there is no atom type {}", type);
            const std::string name = given("material of beads");
            const bool none = name == "none";
            s.beads[type - 1] = none ? -1 : known("beads", name, CONTACTLAW_SPHERES, CONTACTLAW_SPHERE_COUNT);
        } else if (s.walls.empty()) {
            error->all(FLERR, "Fix wall/contactlaw: {}: a wall comes first: plane, plate, mesh or region", word);
        } else {
            Wall &wall = s.walls.back();
            contactlaw_frame &motion = wall.motion;
            const bool moves = word == "move" || word == "rotate" || word == "vibrate";
            if (wall.region && (moves || word == "edges"))
                error->all(FLERR, "Fix wall/contactlaw: {}: not for a region; region {} itself moves by its own words",
                           word, wall.name);
            motion.moves = motion.moves || moves;
            if (word == "thickness") {
                wall.thickness = s.length * number("thickness", 1e-12);
            } else if (word == "material") {
                const std::string name = given("material");
                wall.plate = known("material", name, CONTACTLAW_PLATES, CONTACTLAW_PLATE_COUNT);
            } else if (word == "scale" && wall.mesh) {
                wall.scale *= number("scale", 1e-12);
            } else if (word == "edges") {
                const std::string name = given("kind of edges");
                wall.edges = 1 + known("edges", name, CONTACTLAW_EDGES, 3);
            } else if (word == "move") {
                put(motion.velocity, vector("velocity", s.length / s.time));
            } else if (word == "rotate") {
                put(motion.hub, vector("centre of rotate", s.length));
                const Vector axis = vector("axis of rotate", 1.0);
                if (!(size(axis) > 0.0))
                    error->all(FLERR, "Fix wall/contactlaw: rotate: its axis must have a direction");
                put(motion.axis, (1.0 / size(axis)) * axis);
                motion.spin = number("speed of rotate") / s.time;
            } else if (word == "vibrate") {
                put(motion.amplitude, vector("amplitude of vibrate", s.length));
                motion.frequency = 2.0 * M_PI * number("frequency of vibrate", 0.0) / s.time;
            } else {
                error->all(FLERR, "Fix wall/contactlaw: {}: unknown; README.txt has all words", word);
            }
        }
    }
    if (s.walls.empty())
        error->all(FLERR, "Fix wall/contactlaw: no wall: give a plane, plate, mesh or region");

    const int types = atom->ntypes, count = int(s.walls.size());
    s.rows.resize(size_t(types) * s.walls.size());
    int still = -1;
    for (int n = 0; n < count; ++n) {
        Wall &wall = s.walls[n];
        for (Vector &one : wall.corners) {
            one = wall.mesh ? wall.scale * one : one;
            if (!(size(one) <= CONTACTLAW_FARTHEST))
                error->all(FLERR, "Fix wall/contactlaw: wall {} reaches beyond {:g} m", n + 1, CONTACTLAW_FARTHEST);
        }
        for (int type = 0; type < types; ++type) {
            contactlaw_plate_row &row = s.rows[type * count + n];
            const int pair = std::max(s.beads[type], 0) * CONTACTLAW_PLATE_COUNT + wall.plate;
            std::memcpy(&row, CONTACTLAW_UNITS[pair], sizeof row);
            row.law = (long long)(size_t) CONTACTLAW_LAWS[pair], row.passes = s.beads[type] < 0;
            const double thinner = row.thickness / wall.thickness;
            row.mobility *= thinner * thinner, row.ratio *= thinner, row.thickness = wall.thickness;
            row.alike = std::find(s.beads.begin(), s.beads.end(), s.beads[type]) - s.beads.begin();
        }
        if (wall.region || wall.motion.moves || still < 0) {
            wall.frame = int(s.frames.size());
            s.frames.push_back(wall.motion);
            still = wall.region || wall.motion.moves ? still : wall.frame;
        } else {
            wall.frame = still;
        }
        const size_t first = s.facets.size();
        s.add_facets(n);
        const size_t kept = s.facets.size() - first, all = wall.mesh ? wall.corners.size() / 3 : kept;
        if (kept == 0)
            error->all(FLERR, "Fix wall/contactlaw: mesh: of wall {} all triangles are without area", n + 1);
        if (kept < all && comm->me == 0)
            error->warning(FLERR, "Fix wall/contactlaw: mesh: {} of {} triangles left out: without area, or duplicates",
                           all - kept, all);
    }
    for (contactlaw_facet &one : s.facets)
        if (one.kind != contactlaw_REGION)
            one.edges = (long long)(size_t) (s.edges.data() + one.edges);
    s.grids.resize(s.frames.size());
    s.loads.resize(s.walls.size()), s.pressed.resize(s.facets.size());
    s.shown.assign(NUMBERS * s.walls.size(), 0.0), s.before = s.shown;
    s.places = std::min(int(s.facets.size()), CONTACTLAW_MOST_CONTACTS);
    s.base = (update->atime + double(update->ntimestep - update->atimestep) * update->dt) * s.time;
    s.since = s.base, s.tick = update->dt * s.time;
    columns_ = HEAD + s.places * CONTACT + (s.friction > 0.0 ? s.places * FRICTION : 0);

    vector_flag = scalar_flag = energy_global_flag = 1, size_vector = NUMBERS * count;
    global_freq = 1, extscalar = 1, extvector = 0;
    peratom_flag = 1, size_peratom_cols = 0, peratom_freq = 1;
    restart_global = restart_peratom = 1, create_attribute = 1;
    maxexchange = columns_ + 1;
    if (!record.empty()) { /* a file of numpy's, complete after each run */
        const size_t rank = record.find('%');
        if (rank == std::string::npos && comm->nprocs > 1)
            error->all(FLERR, "Fix wall/contactlaw: record: got {}; on several ranks it needs a %, as in hits.%.npy",
                       record);
        if (rank != std::string::npos)
            record.replace(rank, 1, std::to_string(comm->me));
        s.record = std::fopen(record.c_str(), "wb");
        if (!s.record)
            error->one(FLERR, "Fix wall/contactlaw: record: {} cannot be written: {}", record, utils::getsyserror());
        std::fwrite(contactlaw_npy, 1, sizeof contactlaw_npy, s.record);
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        if (run.fixes++ == 0)
            run.number = std::chrono::duration_cast<std::chrono::microseconds>(now).count(), run.start = s.base;
        MPI_Bcast(&run.number, 1, MPI_LONG_LONG, 0, world);
        count_rows();
    }
    grow_arrays(atom->nmax);
    atom->add_callback(Atom::GROW);
    atom->add_callback(Atom::RESTART);
    for (int i = 0; i < atom->nlocal; ++i)
        set_arrays(i);
}

FixWallContactlaw::~FixWallContactlaw()
{
    if (modify->get_fix_by_id(id))
        atom->delete_callback(id, Atom::GROW), atom->delete_callback(id, Atom::RESTART);
    if (scene_->record)
        --run.fixes, count_rows(), std::fclose(scene_->record);
    memory->destroy(history_);
    memory->destroy(vector_atom);
}

int FixWallContactlaw::setmask()
{
    return POST_FORCE | MIN_POST_FORCE | POST_RUN;
}

void FixWallContactlaw::init()
{
    Scene &s = *scene_;
    if (utils::strmatch(update->integrate_style, "^respa"))
        error->all(FLERR, "Fix wall/contactlaw: not with run_style respa, which has steps of several lengths");
    for (Fix *const other : modify->get_fix_list())
        if (other->rigid_flag && comm->me == 0)
            error->warning(FLERR, "Fix wall/contactlaw answers parts of rigid bodies as beads that fly alone");
    for (const Wall &wall : s.walls)
        if (wall.region != domain->get_region_by_id(wall.name))
            error->all(FLERR, "Fix wall/contactlaw: region: {} was deleted; unfix {} before", wall.name, id);
    double radius = 0.0, largest = 0.0;
    for (int i = 0; i < atom->nlocal; ++i)
        if (atom->mask[i] & groupbit)
            radius = std::max(radius, atom->radius[i] * s.length);
    MPI_Allreduce(&radius, &largest, 1, MPI_DOUBLE, MPI_MAX, world);
    if (largest > s.largest || s.grids[0].starts.empty()) {
        s.largest = std::max(largest, s.largest);
        for (size_t n = 0; n < s.frames.size(); ++n)
            s.fill_grid(int(n));
    }
}

void FixWallContactlaw::setup(int)
{
    step(false);
}

void FixWallContactlaw::post_force(int)
{
    step(true);
}

void FixWallContactlaw::min_post_force(int)
{
    error->all(FLERR, "Fix wall/contactlaw: minimize moves beads without time steps; unfix {} before", id);
}

/* Beads that could jump through a wall in a step, or are no solid spheres of their material. */
void FixWallContactlaw::look()
{
    Scene &s = *scene_;
    for (int i = 0; i < atom->nlocal; ++i) {
        if (!(atom->mask[i] & groupbit) || s.beads[atom->type[i] - 1] < 0)
            continue;
        const Vector at = s.length * vector_of(atom->x[i]);
        double wall = 0.0; /* speed of the fastest wall, of one that turns at the place of the bead */
        for (const contactlaw_frame &one : s.frames) {
            const Vector arm = at - vector_of(one.hub) - vector_of(one.shift);
            const double most = size(vector_of(one.velocity)) + one.frequency * size(vector_of(one.amplitude));
            wall = std::max(wall, std::fabs(one.spin) * size(cross(vector_of(one.axis), arm))
                            + std::max(most, size(vector_of(one.rate)))); /* regions have a rate alone */
        }
        const double speed = size(vector_of(atom->v[i])) * s.length / s.time + wall, r = atom->radius[i] * s.length;
        if (!(speed * update->dt * s.time < r))
            refuse(TOO_FAST, atom->tag[i], -1, speed, r);
        const double mass = atom->rmass[i] * s.mass;
        const double solid = s.rows[(atom->type[i] - 1) * s.walls.size()].mass * r * r * r;
        if (std::fabs(mass - solid) > contactlaw_SOLID * solid)
            refuse(contactlaw_WRONG_MASS, atom->tag[i], -1, mass, solid);
    }
}

void FixWallContactlaw::step(bool advancing)
{
    Scene &s = *scene_;
    const double dt = update->dt * s.time;
    const double before = s.last > 0.0 ? s.last : dt;
    if (advancing)
        s.last = dt;
    if (dt != s.tick)
        s.base += double(s.ticks) * s.tick, s.ticks = 0, s.tick = dt;
    s.ticks += advancing;
    const double now = s.base + double(s.ticks) * s.tick;
    const double time = (update->atime + double(update->ntimestep - update->atimestep) * update->dt) * s.time;
    const contactlaw_clock clock = { time, dt, before, advancing };
    const bool looks = update->ntimestep % EVERY == 0;
    if (advancing && looks && now > s.since) { /* on all ranks */
        const double *const sums = s.loads[0].force;
        std::vector<double> all(s.shown.size());
        MPI_Allreduce(sums, all.data(), int(all.size()), MPI_DOUBLE, MPI_SUM, world);
        for (size_t n = 0; n < all.size(); ++n) {
            const double unit = s.mass * s.length / (s.time * s.time) * (n % NUMBERS > 2 ? s.length : 1.0)
                / (n % NUMBERS == NUMBERS - 1 ? s.time : 1.0);
            s.shown[n] = (all[n] - s.before[n]) / ((now - s.since) * unit);
        }
        s.before = all, s.since = now;
    }
    contactlaw_wall_scene scene = s.kernels();
    contactlaw_move(scene.frames, now, dt);
    s.follow_regions(update->ntimestep, dt);
    if (looks || !advancing)
        look();
    if (update->ntimestep % 10000 == 0)
        count_rows();

    double **const x = atom->x, **const v = atom->v, **const f = atom->f, **const w = atom->omega;
    const double speed = s.length / s.time, rate = 1.0 / s.time;
    const double per_force = s.time * s.time / (s.mass * s.length), per_torque = per_force / s.length;
    const auto around = contactlaw_box(scene.frames);
    for (int i = 0; i < atom->nlocal; ++i) {
        Head &head = *reinterpret_cast<Head *>(history_[i]);
        if (!(atom->mask[i] & groupbit)) { /* a bead that has left the group has left the walls */
            if (head.radius != 0.0)
                set_arrays(i);
            continue;
        }
        const double r = atom->radius[i] * s.length, reach = CONTACTLAW_MARGIN * r;
        const contactlaw_vector at = { x[i][0] * s.length, x[i][1] * s.length, x[i][2] * s.length };
        if (!(around.f2 - reach <= at.f2 && at.f2 <= around.f5 + reach && around.f0 - reach <= at.f0
              && at.f0 <= around.f3 + reach && around.f1 - reach <= at.f1 && at.f1 <= around.f4 + reach
              && contactlaw_near(scene.frames, at, r))) {
            if (head.radius != 0.0)
                set_arrays(i);
            continue;
        }
        const double mass = atom->rmass[i] * s.mass;
        const int kind = atom->type[i] - 1;
        if (head.radius != 0.0
            && (std::fabs(r - head.radius) > SAME * head.radius || std::fabs(mass - head.mass) > SAME * head.mass
                || s.rows[kind * s.walls.size()].alike != s.rows[int(head.kind) * s.walls.size()].alike))
            refuse(CHANGED, atom->tag[i], -1, r, head.radius);
        if (head.radius != 0.0 && (head.softening != s.softening || head.parcel != s.parcel))
            refuse(CLASH, atom->tag[i], -1, head.softening, head.parcel);
        for (int k = 0; k < s.places; ++k) { /* out of a region there are no contacts with it */
            const auto &row = reinterpret_cast<contactlaw_contact_row *>(history_[i] + HEAD)[k];
            if (row.facet == 0.0 || row.overlap < 0.5 * r)
                continue;
            const contactlaw_facet &facet = s.facets[size_t(std::fabs(row.facet)) - 1];
            if (facet.kind == contactlaw_REGION && !region_of(facet)->match(x[i][0], x[i][1], x[i][2]))
                refuse(contactlaw_CROSSED, atom->tag[i], int(facet.wall), size(vector_of(v[i])) * speed, 0.0);
        }
        double sums[2][3] = { { 0.0 }, { 0.0 } };
        double *const rows = history_[i] + HEAD;
        const contactlaw_bead bead = {
            int(atom->tag[i]), kind, at, { v[i][0] * speed, v[i][1] * speed, v[i][2] * speed },
            { w[i][0] * rate, w[i][1] * rate, w[i][2] * rate }, r, mass, sums[0], sums[1],
            { reinterpret_cast<contactlaw_contact_row *>(rows), s.places },
            { reinterpret_cast<contactlaw_friction_row *>(rows + s.places * CONTACT), s.friction > 0.0 ? s.places : 0 }
        };
        contactlaw_interact(scene, clock, bead);
        if (s.status.trouble != 0)
            refuse(int(s.status.trouble), atom->tag[i], int(s.status.wall), s.status.value, s.status.limit);
        for (int n = 0; n < s.status.impacts; ++n) {
            s.impacts[n].run = run.number, s.impacts[n].run_start = run.start;
            if (s.impacts[n].kind == contactlaw_IMPACT)
                vector_atom[i] = head.restitution = s.impacts[n].restitution;
        }
        if (s.record && s.status.impacts > 0)
            s.written += (long long) std::fwrite(s.impacts, sizeof *s.impacts, size_t(s.status.impacts), s.record);
        s.status.impacts = 0;
        for (int k = 0; k < 3; ++k) {
            const double force = sums[0][k] * per_force, torque = sums[1][k] * per_torque;
            f[i][k] += force;
            if (s.friction > 0.0)
                atom->torque[i][k] += torque;
            /* kinetic energy that Verlet's scheme gives in this step; v is of the middle of it */
            const double per = 0.25 * update->dt / atom->rmass[i], turn = per / (0.4 * atom->radius[i] * atom->radius[i]);
            const double moved = (head.force[k] + force) * (v[i][k] + per * (force - head.force[k]));
            const double turned = (head.torque[k] + torque) * (w[i][k] + turn * (torque - head.torque[k]));
            s.energy -= advancing ? 0.5 * update->dt * (moved + (s.friction > 0.0 ? turned : 0.0)) : 0.0;
            head.force[k] = force, head.torque[k] = torque;
        }
        bool touches = false;
        for (int k = 0; k < s.places; ++k)
            touches = touches || bead.contacts.at[k].facet != 0.0;
        if (!touches)
            head.radius = 0.0;
        else if (head.radius == 0.0)
            head.radius = r, head.mass = mass, head.kind = kind, head.softening = s.softening, head.parcel = s.parcel;
    }
}

void FixWallContactlaw::refuse(int code, tagint tag, int wall, double value, double limit)
{
    static const std::map<int, const char *> messages = {
        { contactlaw_STEP_TOO_LARGE,
          "timestep: too large for an impact at {0:.4g} m/s, which needs {3} steps; take {1:.2g} s or less" },
        { contactlaw_NO_MODEL, "beads: there are no materials for atom type {0:.0f}" },
        { contactlaw_STARTS_INSIDE,
          "the first touch finds it {0:.4g} m deep in the wall, more than its speed explains; place it outside, or "
          "at most {1:.2g} m deep" },
        { contactlaw_CROSSED,
          "its centre went through the wall at {0:.4g} m/s: take a shorter timestep, less softening or less load" },
        { contactlaw_WRONG_MASS,
          "density: its mass is {0:.6g} kg, a solid sphere of its material has {1:.6g} kg; set its density to that "
          "of the material, which README.txt has" },
        { contactlaw_TOO_THIN,
          "thickness: the wall is too thin for the bead: its inelasticity lambda = {0:.4g} is above {1:.4g}; take a "
          "thicker wall or smaller beads" },
        { contactlaw_FOIL,
          "thickness: the wall is a foil beside the bead, R/H = {0:.4g} is above {1:.4g}; take a thicker wall" },
        { contactlaw_NO_FORCE, "no finite force at {0:.4g} m/s and a radius of {1:.4g} m" },
        { contactlaw_TOO_WIDE, "radius: inside a round wall of {1:.8g} m, which a bead of {0:.8g} m does not fit into" },
        { TOO_FAST,
          "timestep: at {0:.4g} m/s it flies further than its radius of {1:.4g} m in a step, and could jump through "
          "a wall; take {2:.2g} s at most" },
        { CHANGED,
          "diameter, density or type: changed while it touches a wall: its radius is {0:.6g} m and was {1:.6g} m; "
          "change beads that touch nothing" },
        { CLASH,
          "softening, parcel: it has touched a wall with {0:g}, {1:g}; take these again, or wait until it has left" },
    };
    count_rows();
    const std::string what = fmt::format(fmt::runtime(messages.at(code)), value, limit, value > 0.0 ? limit / value : 0.0,
                                         contactlaw_FEWEST_STEPS);
    error->one(FLERR, "Fix wall/contactlaw: bead {}{} at step {}: {}", tag,
               wall >= 0 ? fmt::format(" on wall {}", wall + 1) : "", update->ntimestep, what);
}

void FixWallContactlaw::post_run()
{
    Scene &s = *scene_;
    if (s.status.overlap > CONTACTLAW_DEEPEST_OVERLAP)
        error->warning(FLERR, "Fix wall/contactlaw: an impact at {:.3g} m/s had an overlap of {:.2g} of the radius; take "
                       "less softening", s.status.speed, s.status.overlap);
    s.status.overlap = 0.0;
    count_rows();
}

/* Write into the head of the record how many rows it has. */
void FixWallContactlaw::count_rows()
{
    Scene &s = *scene_;
    if (!s.record)
        return;
    std::fseek(s.record, CONTACTLAW_NPY_ROWS, SEEK_SET);
    std::fprintf(s.record, CONTACTLAW_NPY_DIGITS, s.written);
    std::fseek(s.record, 0, SEEK_END);
    std::fflush(s.record);
}

/* Energy that the beads have given to the walls since the fix began. */
double FixWallContactlaw::compute_scalar()
{
    double all = 0.0;
    MPI_Allreduce(&scene_->energy, &all, 1, MPI_DOUBLE, MPI_SUM, world);
    return all;
}

double FixWallContactlaw::compute_vector(int n)
{
    return scene_->shown[n];
}

double FixWallContactlaw::memory_usage()
{
    return double(atom->nmax) * (columns_ + 1) * sizeof(double);
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

/* Only beads that touch a wall have more than a Head. */
int FixWallContactlaw::pack_exchange(int i, double *to)
{
    const int count = history_[i][0] != 0.0 ? columns_ : HEAD;
    to[0] = count;
    std::copy_n(history_[i], count, to + 1);
    return count + 1;
}

int FixWallContactlaw::unpack_exchange(int i, double *from)
{
    set_arrays(i);
    std::copy_n(from + 1, int(from[0]), history_[i]);
    vector_atom[i] = reinterpret_cast<Head *>(history_[i])->restitution;
    return int(from[0]) + 1;
}

int FixWallContactlaw::pack_restart(int i, double *to)
{
    to[0] = maxsize_restart();
    std::copy_n(history_[i], columns_, to + 1);
    return maxsize_restart();
}

void FixWallContactlaw::unpack_restart(int i, int nth)
{
    double *from = atom->extra[i];
    for (int n = 0; n < nth; ++n)
        from += int(*from);
    set_arrays(i);
    if (int(*from) != maxsize_restart() && from[1] != 0.0)
        error->one(FLERR, "Fix wall/contactlaw: bead {} touches other walls in the restart file; give the fix {} "
                   "the same walls, and friction or none as before", atom->tag[i], id);
    if (int(*from) == maxsize_restart())
        std::copy_n(from + 1, columns_, history_[i]);
    vector_atom[i] = reinterpret_cast<Head *>(history_[i])->restitution;
}

int FixWallContactlaw::size_restart(int)
{
    return maxsize_restart();
}

int FixWallContactlaw::maxsize_restart()
{
    return columns_ + 1;
}

void FixWallContactlaw::write_restart(FILE *file)
{
    const double all = compute_scalar(), kept[] = { scene_->base, scene_->tick, double(scene_->ticks), scene_->last, all };
    const int bytes = sizeof kept;
    if (comm->me == 0)
        std::fwrite(&bytes, sizeof bytes, 1, file), std::fwrite(kept, 1, sizeof kept, file);
}

void FixWallContactlaw::restart(char *from)
{
    double kept[5];
    std::memcpy(kept, from, sizeof kept);
    scene_->base = kept[0], scene_->tick = kept[1], scene_->ticks = (long long) kept[2], scene_->last = kept[3];
    scene_->since = kept[0] + kept[1] * kept[2], scene_->energy = comm->me == 0 ? kept[4] : 0.0;
}
