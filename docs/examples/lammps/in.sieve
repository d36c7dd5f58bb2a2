# Beads of two sizes on a vibrating deck of sheet metal, a mesh with openings of 5 mm; contacts are softened:
#     contactlaw export lammps sieve.toml --out wall
#     sh wall/build.sh
#     lmp -in in.sieve           or    mpirun -np 2 lmp -in in.sieve
#     contactlaw report hits.*.npy --scene wall/sieve.scene
units si
atom_style sphere
boundary f f f
comm_modify vel yes
region box block -0.05 0.15 -0.05 0.1 -0.25 0.1
create_box 1 box
region feed block 0.004 0.06 0.004 0.04 0.008 0.06
create_atoms 1 random 100 21 feed overlap 6.5e-3 maxtry 500
group coarse id <= 50
set group all diameter 4e-3
set group coarse diameter 6e-3
set group all density 879
velocity all set 0.2 0 -1

# What the beads do to each other: contactlaw.engines.lammps.pair_coeff writes this line.
pair_style granular
pair_coeff * * hertz/material 4.07667e+08 0.999087 0.21 tangential mindlin NULL 0 0.3 damping coeff_restitution

plugin load wall/contactlaw.so
fix deck all wall/contactlaw wall/sieve.scene record hits.%.npy
fix move all nve/sphere
fix weight all gravity 9.80665 vector 0 0 -1

variable below atom "z < -5e-3"
compute below all reduce sum v_below
variable gone equal 100-atoms+c_below
thermo_style custom step time f_deck[3] f_deck[7] f_deck v_gone
thermo_modify norm no lost ignore
thermo 20000
timestep 1e-6
run 200000
