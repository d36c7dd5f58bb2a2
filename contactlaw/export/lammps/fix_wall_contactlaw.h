/* Fix wall/contactlaw of LAMMPS. LAMMPS is under the GPL, version 2, and so is what is compiled with
 * its headers. */
#ifdef FIX_CLASS
FixStyle(wall/contactlaw,FixWallContactlaw);
#else
#ifndef FIX_WALL_CONTACTLAW_H
#define FIX_WALL_CONTACTLAW_H

#include "fix.h"

#include <memory>

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
    double **history_; /* of each bead: a contactlaw_head, its contacts, their friction */
    int columns_;

    void read(const std::string &);
    void open(std::string);
    double time();
    void step(bool);
    void write_rows();
    void count_rows();
};

}

#endif
#endif
