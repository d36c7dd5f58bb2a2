/* Fix wall/contactlaw of LAMMPS: README.txt says how it is used. LAMMPS is under the GPL, version 2,
 * and so is what is compiled with its headers. */
#ifdef FIX_CLASS
FixStyle(wall/contactlaw,FixWallContactlaw);
#else
#ifndef FIX_WALL_CONTACTLAW_H
#define FIX_WALL_CONTACTLAW_H

#include "fix.h"

#include <memory>
#include <string>

namespace LAMMPS_NS
{

class FixWallContactlaw : public Fix
{
  public:
    FixWallContactlaw(LAMMPS *, int, char **);
    ~FixWallContactlaw() override;
    int setmask() override;
    void init() override;
    void setup(int) override;
    void post_force(int) override;
    void min_post_force(int) override;
    void post_run() override;
    double compute_scalar() override;
    double compute_vector(int) override;
    double memory_usage() override;

    void grow_arrays(int) override;
    void copy_arrays(int, int, int) override;
    void set_arrays(int) override;
    int pack_exchange(int, double *) override;
    int unpack_exchange(int, double *) override;
    int pack_restart(int, double *) override;
    void unpack_restart(int, int) override;
    int size_restart(int) override;
    int maxsize_restart() override;
    void write_restart(FILE *) override;
    void restart(char *) override;

  private:
    struct Scene; /* walls, and what the kernels of contactlaw have of them */
    std::unique_ptr<Scene> scene_;
    double **history_; /* of each bead: a Head, its contacts, their friction */
    int columns_;

    void step(bool);
    void look();
    void count_rows();
    void refuse(int, tagint, int, double, double);
};

}

#endif
#endif
