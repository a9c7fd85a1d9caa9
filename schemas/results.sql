-- The store of clast: schema of version 5.
-- Made from the tables in db/store/schema.c and the engines' field tables; do not edit: a test compares.
-- Views have, besides, one column per input that some campaign varied (table axis).
PRAGMA application_id = 1129075540;
PRAGMA user_version = 5;

CREATE TABLE column_doc ( -- Meaning and unit of every column.
  table_name TEXT NOT NULL, -- table or view
  column_name TEXT NOT NULL, -- column of it
  unit TEXT, -- SI unit; NULL where there is none
  meaning TEXT NOT NULL, -- what the column holds
  deterministic INTEGER NOT NULL DEFAULT 0, -- 1: a result that depends on inputs, seed and results_version alone (not a time, a host...)
  PRIMARY KEY (table_name, column_name)
) STRICT, WITHOUT ROWID;

CREATE TABLE campaign ( -- Campaigns, as their files were read.
  campaign_id INTEGER PRIMARY KEY, -- number of the campaign in this store
  name TEXT NOT NULL, -- its name
  document TEXT NOT NULL, -- the campaign file as it was read
  plan TEXT, -- the resolved plan, JSON
  added_at TEXT NOT NULL -- when it was first run, UTC, ISO 8601
) STRICT;

CREATE TABLE session ( -- Provenance: one row per invocation that wrote to the store.
  session_id INTEGER PRIMARY KEY, -- number of the invocation that computed
  campaign_id INTEGER, -- the campaign it computed; NULL in sessions of older programs that computed nothing
  started_at TEXT NOT NULL, -- UTC, ISO 8601, to the millisecond
  ended_at TEXT, -- UTC, ISO 8601; NULL while running or when it was killed
  outcome TEXT, -- how it ended: a status name; NULL while running or when it was killed
  host TEXT NOT NULL, -- machine of the manager
  pid INTEGER NOT NULL, -- process of the manager
  facts TEXT NOT NULL CHECK (json_valid(facts)) -- provenance, JSON: version, commit, compiler, flags, processor class, libraries, ranks, slots, command line
) STRICT;

CREATE TABLE point ( -- Points: sets of input values. The resolved scene is the truth.
  point_id INTEGER PRIMARY KEY, -- number of the point: one set of input values
  hash BLOB NOT NULL UNIQUE CHECK (length(hash) = 16), -- 128-bit hash of engine and active inputs, without seed and results_version
  digest BLOB CHECK (length(digest) = 16), -- changes when any bit of the point or its inputs changes
  engine TEXT NOT NULL, -- name of the engine
  scene_name TEXT NOT NULL, -- name of the scene the inputs started from
  scene TEXT NOT NULL CHECK (json_valid(scene)) -- the resolved scene, JSON, SI units: every active input, defaults too
) STRICT;

CREATE TABLE campaign_point ( -- Which campaign has which point.
  campaign_id INTEGER NOT NULL REFERENCES campaign (campaign_id), -- a campaign with this point
  point_id INTEGER NOT NULL REFERENCES point (point_id), -- a point of it; campaigns may share points
  PRIMARY KEY (campaign_id, point_id)
) STRICT, WITHOUT ROWID;

CREATE TABLE point_input ( -- Every active input of every point.
  point_id INTEGER NOT NULL REFERENCES point (point_id), -- the point
  path TEXT NOT NULL, -- path of an active input in the scene
  value ANY NOT NULL, -- its value in SI units; choices by name, booleans 0 or 1, the keyword off as text
  PRIMARY KEY (point_id, path)
) STRICT, WITHOUT ROWID;

CREATE TABLE shape_file ( -- Shape files of bodies, each once.
  hash TEXT NOT NULL UNIQUE, -- SHA-256 of the file, the value of inputs that name one (target.mesh.file)
  bytes BLOB NOT NULL -- the file as it was read, STL or OBJ
) STRICT;

CREATE TABLE axis ( -- Inputs that some campaign varied: columns of the views.
  path TEXT NOT NULL PRIMARY KEY, -- path of an input that some campaign varied
  column_name TEXT NOT NULL UNIQUE, -- its column in the views
  unit TEXT, -- SI unit of the input
  written_unit TEXT, -- unit of its values in the campaign: that of tables for people; NULL: SI
  meaning TEXT NOT NULL -- what the input means
) STRICT, WITHOUT ROWID;

CREATE TABLE run ( -- Runs: one simulation of a point with a seed, and what every engine reports of it.
  run_id INTEGER PRIMARY KEY, -- number of the run in this store
  point_id INTEGER NOT NULL REFERENCES point (point_id), -- the point it belongs to
  session_id INTEGER REFERENCES session (session_id), -- the session that computed it
  identity BLOB NOT NULL UNIQUE CHECK (length(identity) = 16), -- 128-bit hash of engine, results_version, active inputs and seed: the same run is never stored twice
  replicate INTEGER NOT NULL, -- which seed of the point, from 0
  seed INTEGER NOT NULL, -- the seed (64 bits, shown as a signed number)
  results_version INTEGER NOT NULL, -- version of the engine's results; statistics never mix two
  surplus INTEGER NOT NULL, -- above 0: left out of statistics. 1: beyond the prefix a stopping rule decided on; 2: excluded; 3: both
  attempt INTEGER NOT NULL, -- which attempt succeeded, from 1
  wall_time REAL NOT NULL, -- [s] elapsed time of the successful attempt
  cpu_time REAL NOT NULL, -- [s] processor time of the successful attempt
  peak_memory INTEGER NOT NULL, -- [B] largest resident memory of the successful attempt
  host TEXT, -- machine that computed it
  rank INTEGER NOT NULL, -- MPI rank that computed it
  finished_at REAL NOT NULL, -- [s] when it was stored, seconds since 1970-01-01 UTC
  fields_path TEXT, -- HDF5 file with its fields, relative to the store's folder; NULL when none was kept
  fields_digest TEXT, -- changes when any bit of that file changes; NULL in older rows
  excluded TEXT, -- why a person excluded the run (clast exclude); NULL: it is not excluded
  excluded_at TEXT, -- when, UTC, ISO 8601
  counts INTEGER NOT NULL CHECK (counts = (surplus = 0 AND state IN ('completed', 'end-time') AND largest_fraction IS NOT NULL AND second_fraction IS NOT NULL AND fragment_count IS NOT NULL AND dust_fraction IS NOT NULL AND mean_fragment_mass IS NOT NULL)), -- 1: part of the statistics (not surplus or excluded, completed or ended at its time, the main results are numbers)
  digest BLOB CHECK (length(digest) = 16), -- changes when any bit changes of what the run determined: results, masses, estimates, seed, identity
  state TEXT, -- How the run ended: with a usable result (completed, end-time), or without one. One of: completed, end-time, not-finite, time-step, energy, invalid
  message TEXT, -- What went wrong, in words; empty when nothing did.
  warnings TEXT, -- Conditions that a usable run does not meet, a word for each; empty when it meets all.
  steps INTEGER, -- [1] Time steps taken.
  time REAL, -- [s] Simulated time at the end.
  time_step REAL, -- [s] The smallest time step used.
  total_mass REAL, -- [kg] Mass of the body at the end (two dimensions: per metre of thickness).
  energy_error REAL, -- [1] Energy gained or lost by numerical errors, as a share of the energy put in; in sph without the energy of the motion of all matter together, which no collision can use.
  momentum_error REAL, -- [1] Change of total momentum minus the impulse of external forces, as a share of the sum of the momenta of all grains or particles.
  fragment_count INTEGER, -- [1] Fragments of any size, single grains (dust) included.
  single_count INTEGER, -- [1] Fragments of one grain or particle: below the model's resolution.
  dust_fraction REAL, -- [1] Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).
  complete_mass REAL, -- [kg] The spectrum of fragments is complete from this mass on: 10 particles (sph: 9.5 of the heaviest) or 2 grains (dem: 1.5 mean ones). Exponents use heavier fragments only.
  largest_fraction REAL, -- [1] Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).
  second_fraction REAL, -- [1] Mass of the second largest fragment over the total mass, M_2/M.
  mean_fragment_mass REAL, -- [kg] Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.
  mean_fragment_mass_rest REAL, -- [kg] The same without the largest fragment.
  kinetic_energy_share REAL -- [1] Translation energy of the fragments over the energy put in.
) STRICT;

CREATE INDEX run_statistics ON run (point_id, results_version, counts, replicate, seed, state, largest_fraction, second_fraction, fragment_count, dust_fraction, mean_fragment_mass);

CREATE TABLE fragment_mass ( -- Fragment masses: any spectrum can be made from them without a new run.
  run_id INTEGER PRIMARY KEY REFERENCES run (run_id), -- the run
  masses BLOB NOT NULL, -- [kg] mass of every fragment, descending: little-endian float64, 8 bytes each
  lengths BLOB -- [m] three lengths of each fragment, longest first, in the order of the masses up to the last that was measured, 0 for others: little-endian float64; NULL: none was measured
) STRICT;

CREATE TABLE bin ( -- Edges of the mass bins in use.
  bin INTEGER PRIMARY KEY, -- number of a mass bin: ten per decade, bin 0 starts at 1 kg
  lower REAL NOT NULL, -- [kg] lower edge, inside the bin
  upper REAL NOT NULL -- [kg] upper edge, outside the bin
) STRICT;

CREATE TABLE spectrum ( -- Fragment mass spectrum of each run.
  run_id INTEGER NOT NULL REFERENCES run (run_id), -- the run
  bin INTEGER NOT NULL, -- mass bin (table bin); only bins that hold something
  count INTEGER NOT NULL, -- [1] fragments in the bin
  mass REAL NOT NULL, -- [kg] their mass
  PRIMARY KEY (run_id, bin)
) STRICT, WITHOUT ROWID;

CREATE TABLE ejecta ( -- Ejecta of each impact over their speed.
  run_id INTEGER NOT NULL REFERENCES run (run_id), -- the run
  bin INTEGER NOT NULL, -- number of a bin of speed: ten per decade, bin 0 starts at 1 m/s
  speed REAL NOT NULL, -- [m/s] lower edge of the bin, inside it; only bins that hold something
  mass REAL NOT NULL, -- [kg] mass of the target's matter that leaves at such a speed (result ejecta.mass_fraction)
  momentum REAL NOT NULL, -- [kg m/s] its momentum along the outward normal (result ejecta.momentum)
  PRIMARY KEY (run_id, bin)
) STRICT, WITHOUT ROWID;

CREATE TABLE point_total ( -- Running totals of each point, kept in the transaction that adds the runs.
  point_id INTEGER NOT NULL REFERENCES point (point_id), -- the point
  results_version INTEGER NOT NULL, -- version of the engine's results
  runs INTEGER NOT NULL, -- [1] runs that count: completed, or ended at their time, not surplus, not excluded
  censored INTEGER NOT NULL, -- [1] runs that count and ended at their time: fragments may still have been breaking
  failed INTEGER NOT NULL, -- [1] runs that gave no usable result (NaN, time step, energy, invalid)
  surplus INTEGER NOT NULL, -- [1] runs left out because a stopping rule decided without them
  fragments INTEGER NOT NULL, -- [1] fragments of the runs that count
  mass REAL NOT NULL, -- [kg] mass of these fragments
  PRIMARY KEY (point_id, results_version)
) STRICT, WITHOUT ROWID;

CREATE TABLE point_spectrum ( -- Running pooled spectrum of each point, kept in the transaction that adds the runs.
  point_id INTEGER NOT NULL REFERENCES point (point_id), -- the point
  results_version INTEGER NOT NULL, -- version of the engine's results
  bin INTEGER NOT NULL, -- mass bin (table bin)
  runs INTEGER NOT NULL, -- [1] runs that count and have a fragment in the bin
  count INTEGER NOT NULL, -- [1] sum of their counts
  count_squared INTEGER NOT NULL, -- [1] sum of the squares of their counts, for the scatter between runs
  mass REAL NOT NULL, -- [kg] sum of their masses
  PRIMARY KEY (point_id, results_version, bin)
) STRICT, WITHOUT ROWID;

CREATE TABLE estimate ( -- Estimates made from the fragments of one run; they can be made again at any time.
  run_id INTEGER NOT NULL REFERENCES run (run_id), -- the run
  ordinal INTEGER NOT NULL, -- number among the estimates of the run
  window TEXT, -- Window of masses of the estimate. None begins below complete_mass of the run. One of: from_2, from_5, from_10
  method TEXT, -- Method of the estimate. One of: least_squares, masses, cutoff
  headline INTEGER, -- 1: the estimate that is called beta, by maximum likelihood on masses of at least 5 elements (grains or particles), without the largest fragment.
  lower REAL, -- [kg] Lower end of the window used (2D: kg per metre of thickness).
  upper REAL, -- [kg] Upper end, not part of the window: the mass of the largest fragment, or a bin edge. With least_squares a decade above the lower end.
  n INTEGER, -- [1] Fragments in the window.
  beta REAL, -- [1] Exponent of F(m) ~ m^-beta, fragments per unit mass (differential; the cumulative slope is beta - 1). Off when there are too few fragments.
  standard_error REAL, -- [1] Standard error of beta. Of one run: fragments are taken as independent, which they are not; it is no interval over seeds. Of a point: from leaving out one of its runs after another (jackknife), and as of one run where this gives no interval.
  hw95 REAL, -- [1] Half width of the 95 % interval of beta over the runs (seeds) of a point: Student's t and the jackknife. Off for one run. It does not hold the error of the resolution.
  cutoff_mass REAL, -- [kg] m_c of m^-beta exp(-m/m_c); method cutoff only. Off when the pure power law fits best.
  ks_distance REAL, -- [1] Largest distance between the distribution functions of sample and fit; method masses only.
  log_likelihood REAL, -- [1] Natural logarithm of the likelihood of ln(m). Compare within one window only.
  PRIMARY KEY (run_id, ordinal)
) STRICT, WITHOUT ROWID;

CREATE TABLE point_estimate ( -- Estimates pooled over the runs of a point that count.
  point_id INTEGER NOT NULL REFERENCES point (point_id), -- the point
  results_version INTEGER NOT NULL, -- version of the engine's results it was made from
  ordinal INTEGER NOT NULL, -- number among the estimates of the point
  window TEXT, -- Window of masses of the estimate. None begins below complete_mass of the run. One of: from_2, from_5, from_10
  method TEXT, -- Method of the estimate. One of: least_squares, masses, cutoff
  headline INTEGER, -- 1: the estimate that is called beta, by maximum likelihood on masses of at least 5 elements (grains or particles), without the largest fragment.
  lower REAL, -- [kg] Lower end of the window used (2D: kg per metre of thickness).
  upper REAL, -- [kg] Upper end, not part of the window: the mass of the largest fragment, or a bin edge. With least_squares a decade above the lower end.
  n INTEGER, -- [1] Fragments in the window.
  beta REAL, -- [1] Exponent of F(m) ~ m^-beta, fragments per unit mass (differential; the cumulative slope is beta - 1). Off when there are too few fragments.
  standard_error REAL, -- [1] Standard error of beta. Of one run: fragments are taken as independent, which they are not; it is no interval over seeds. Of a point: from leaving out one of its runs after another (jackknife), and as of one run where this gives no interval.
  hw95 REAL, -- [1] Half width of the 95 % interval of beta over the runs (seeds) of a point: Student's t and the jackknife. Off for one run. It does not hold the error of the resolution.
  cutoff_mass REAL, -- [kg] m_c of m^-beta exp(-m/m_c); method cutoff only. Off when the pure power law fits best.
  ks_distance REAL, -- [1] Largest distance between the distribution functions of sample and fit; method masses only.
  log_likelihood REAL, -- [1] Natural logarithm of the likelihood of ln(m). Compare within one window only.
  PRIMARY KEY (point_id, results_version, ordinal)
) STRICT, WITHOUT ROWID;

CREATE TABLE attempt ( -- Attempts that failed: limits, crashes, lost workers.
  attempt_id INTEGER PRIMARY KEY, -- number of the failed attempt
  identity BLOB NOT NULL CHECK (length(identity) = 16), -- identity of the run that was tried
  point_id INTEGER NOT NULL REFERENCES point (point_id), -- its point
  replicate INTEGER NOT NULL, -- which seed of the point, from 0
  seed INTEGER NOT NULL, -- the seed (64 bits, shown as a signed number)
  session_id INTEGER REFERENCES session (session_id), -- the session that tried
  number INTEGER NOT NULL, -- which attempt, from 1
  reason TEXT NOT NULL, -- time_limit, memory_limit, crash, lost or exit
  exit_code INTEGER NOT NULL, -- exit code of the process
  signal INTEGER NOT NULL, -- signal that ended it, 0 for none
  wall_time REAL NOT NULL, -- [s] elapsed time
  peak_memory INTEGER NOT NULL, -- [B] largest resident memory
  limited_to REAL NOT NULL, -- the limit that ended it: seconds or bytes, 0 for the other reasons
  message TEXT NOT NULL, -- its message
  host TEXT, -- machine
  rank INTEGER NOT NULL, -- MPI rank
  failed_at REAL NOT NULL -- [s] when, seconds since 1970-01-01 UTC
) STRICT;

CREATE INDEX attempt_identity ON attempt (identity);

CREATE INDEX attempt_point ON attempt (point_id);

CREATE TABLE convergence ( -- Studies of convergence (clast converge): the levels of each knob, for each quantity.
  base_point_id INTEGER NOT NULL REFERENCES point (point_id), -- the scene studied, as a point
  results_version INTEGER NOT NULL, -- version of the engine's results
  level INTEGER NOT NULL, -- number of the level, from 0, coarse to fine
  point_id INTEGER NOT NULL REFERENCES point (point_id), -- the level, as a point: its runs are in run
  knob TEXT, -- What was made coarser or finer (`clast converge --list`).
  quantity TEXT, -- Result, as a column of the view runs. Its unit is that of mean, bias and error.
  setting TEXT, -- Value of the knob's first input at this level.
  base INTEGER, -- 1: the scene's own setting.
  reference INTEGER, -- 1: the finest level, or the choice that the others are compared with.
  paired INTEGER, -- 1: levels are compared seed by seed.
  step REAL, -- Size that goes to zero as the knob gets finer, such as particles^(-1/3). Off: none.
  n INTEGER, -- [1] Seeds with a usable result.
  mean REAL, -- Mean over seeds.
  half_width REAL, -- Half width of the 95 % interval of the mean (Student's t).
  deviation REAL, -- Standard deviation between seeds.
  skew REAL, -- Skewness over seeds. Off for fewer than 20.
  upper_mode REAL, -- Share of the runs in the upper of two modes (`clast scatter`). Off: one mode.
  cpu REAL, -- [s] Mean processor time of a run.
  bias REAL, -- Mean of this level less that of the reference.
  bias_half_width REAL, -- Half width of the 95 % interval of the bias.
  correlation REAL, -- Pearson's correlation over seeds with the next finer level.
  correlation_low REAL, -- Lower end of its 95 % interval (Fisher).
  correlation_high REAL, -- Upper end of it.
  cost_ratio REAL, -- w: processor time of a run over that of the next finer level.
  break_even REAL, -- 2 sqrt(w)/(1 + w): correlation from which a control variate would save time.
  gain REAL, -- Plain Monte Carlo's cost over that of the best control variate; 1: it saves nothing.
  distance REAL, -- Mean less its limit: the middle of the 95 % interval. Off: no limit is seen.
  distance_half_width REAL, -- Half width of that interval.
  resolution REAL, -- What this knob leaves unknown at this level: the largest distance to the limit in its interval, or |bias| and half width where no limit is seen; 0 where all runs are equal. Off for knobs that are no resolution.
  open INTEGER, -- 1: no limit is in sight, so that resolution may be larger; with 0: no run differs.
  error REAL, -- What all knobs of group resolution together leave unknown at this level: half_width of the view resolution after the last study. Off where it is not known.
  frontier INTEGER, -- 1: no other level of the scene here has an error and a cpu that are both not larger, and one of them smaller (Pareto).
  PRIMARY KEY (base_point_id, results_version, knob, quantity, level)
) STRICT, WITHOUT ROWID;

CREATE TABLE convergence_limit ( -- Limit of each knob of a study, for each quantity.
  base_point_id INTEGER NOT NULL REFERENCES point (point_id), -- the scene studied, as a point
  results_version INTEGER NOT NULL, -- version of the engine's results
  knob TEXT, -- What was made coarser or finer.
  quantity TEXT, -- Result, as a column of the view runs. Its unit is that of the limit.
  verdict TEXT, -- What all levels and seeds together tell. One of: too-few, constant, limit, no-limit, falling
  dropped INTEGER, -- [1] Coarse levels that the law does not describe.
  fit REAL, -- Share of the samples of the best law that lie farther from it than the levels; below 0.05 no law fits.
  fit_with REAL, -- The same with the finest of the dropped levels. Off: none is dropped.
  measured_order REAL, -- p of limit + a step^p that fits best.
  measured_order_low REAL, -- Lower end of its 95 % interval, 0.5 at least.
  measured_order_high REAL, -- Upper end of it, 3 at most.
  extrapolated REAL, -- Value at step 0: mean over the laws, by their likelihood.
  extrapolated_low REAL, -- Lower end of its 95 % interval over all laws.
  extrapolated_high REAL, -- Upper end of it.
  one_power_low REAL, -- Lower end of the interval of the laws with one power alone: two errors against each other are left out. Off: the levels reject one power.
  one_power_high REAL, -- Upper end of it.
  change REAL, -- Mean of the finest level less that of the next coarser one.
  change_low REAL, -- Lower end of its 95 % interval.
  change_high REAL, -- Upper end of it.
  PRIMARY KEY (base_point_id, results_version, knob, quantity)
) STRICT, WITHOUT ROWID;

CREATE TABLE table_digest ( -- Number and digest of all rows of a table, for `clast check`.
  table_name TEXT NOT NULL PRIMARY KEY, -- a table whose rows no other digest protects from loss
  row_count INTEGER NOT NULL, -- its rows, counted in the transaction that changed them
  digest BLOB NOT NULL CHECK (length(digest) = 16) -- changes when any bit of any of its rows changes
) STRICT, WITHOUT ROWID;

CREATE TABLE holder ( -- The process that holds the store for writing, for the message of a refusal.
  holder_id INTEGER PRIMARY KEY CHECK (holder_id = 1), -- always 1
  host TEXT NOT NULL, -- machine of the process that last opened the store for writing
  pid INTEGER NOT NULL, -- its process number; the row only names the holder, the store is held by an OS lock
  since TEXT NOT NULL -- when it did, UTC, ISO 8601
) STRICT;

CREATE TABLE result_dem ( -- What this engine reports beyond the columns of table run, one to one.
  run_id INTEGER PRIMARY KEY REFERENCES run (run_id), -- the run
  stop_reason TEXT, -- Why the run ended. One of: running, quiet, end-time, strain, failure, fault
  grains INTEGER, -- [1] Number of grains, without the explosive one.
  beams INTEGER, -- [1] Number of beams at the start, without those of the explosive grain.
  broken INTEGER, -- [1] Beams broken.
  broken_stretch INTEGER, -- [1] Broken beams for which the stretching term of the breaking rule was the larger one.
  broken_bend INTEGER, -- [1] Broken beams for which the bending term was the larger one.
  broken_share REAL, -- [1] Broken beams over all beams.
  first_break REAL, -- [s] Time of the first break; off when none broke.
  last_break REAL, -- [s] Time of the last break; off when none broke.
  energy_input REAL, -- [J/m] Energy put in: initial kinetic energy (collision: in the common frame), or the work of the load.
  threshold_energy REAL, -- [J/m] Energy that would bring every beam, unbent, to its own threshold. Off without breaking.
  stable_time_step REAL, -- [s] Longest stable time step of the body as it starts: 2/omega_max for `verlet`, 0.54/omega_max for `gear`.
  sound_speed_extension REAL, -- [m/s] Estimate sqrt(E/rho): beams alone, aligned with the wave (the square lattice's value).
  sound_speed_compression REAL, -- [m/s] Estimate sqrt((E + Y sqrt(pi)/2)/rho): beams and contacts, aligned with the wave.
  overlap_share REAL, -- [1] Pairs of grains that overlap, at the end, over the pairs that were neighbours at the start. Above 1 if many grains overlap that were none.
  passing_share REAL, -- [1] Fastest approach of two near grains that no beam joins and whose paths meet, over the speed at which they pass through each other. Above 1 the model has no answer for them. Off without contacts.
  angular_momentum_error REAL, -- [1] Change of the angular momentum about the origin, over the larger of its value at the start and the sum of the momenta times half of the body's size. Off for bodies between moving sides.
  late_breaks INTEGER, -- [1] Beams broken in the second half of the run's time.
  largest_loss REAL, -- [1] Loss of M_1/M of the largest fragment in the second half of the run's time; 0 for a final run. Expect about as much in the next doubling of the time.
  energy_kinetic REAL, -- [J/m] Kinetic energy at the end.
  energy_vibration REAL, -- [J/m] Part of the kinetic energy that is motion inside fragments: neither their translation nor their rotation. Without damping it does not decay, and breaks more beams.
  energy_beam REAL, -- [J/m] Energy stored in beams at the end.
  energy_contact REAL, -- [J/m] Energy stored in contacts at the end (printed law: work done on contacts, of which only a part can return).
  energy_damping REAL, -- [J/m] Energy taken by damping.
  energy_friction REAL, -- [J/m] Energy taken by friction.
  energy_broken_beam REAL, -- [J/m] Energy of the beams when they broke: the energy of the new surfaces. With contact.bonded off, less what contacts store that begin with a break.
  energy_external_work REAL, -- [J/m] Work done by moving boundaries.
  young_modulus REAL, -- [Pa] K: slope of stress against strain under uniaxial load, up to the first break.
  poisson_ratio REAL, -- [1] nu: minus the slope of lateral against axial strain.
  strength REAL, -- [Pa] Largest stress under load, at any time step.
  failure_strain REAL, -- [1] Strain at the largest stress.
  final_strain REAL, -- [1] Strain at the end of the loading.
  upright_share REAL, -- [1] Compression: broken beams whose crack (the common side) lies within 30 degrees of the load's direction, over all broken beams, up to the largest stress. Of isotropic sides it would be 1/3.
  end_triangle_share REAL -- [1] Compression: share of beams broken inside the two 45-degree triangles on the confined ends, over the same share outside them, up to the largest stress. 0 is intact triangles, 1 no pattern.
) STRICT;

CREATE TABLE result_sph ( -- What this engine reports beyond the columns of table run, one to one.
  run_id INTEGER PRIMARY KEY REFERENCES run (run_id), -- the run
  stop_reason TEXT, -- Why the run ended. One of: running, quiet, end-time, fault
  particles INTEGER, -- [1] Number of particles in the target (in both bodies of a collision).
  projectile_particles INTEGER, -- [1] Number of particles in the projectile or piston.
  flaws INTEGER, -- [1] Number of explicit flaws in all bodies.
  target_mass REAL, -- [kg] Mass of the target, in a collision of both bodies. All mass fractions are shares of it, so they leave the projectile out.
  projectile_mass REAL, -- [kg] Mass of the projectile; off without one.
  specific_energy REAL, -- [J/kg] Q: kinetic energy of the projectile over the mass of the target; off without a projectile.
  fracture_ceased INTEGER, -- Fracture ceased by the rule of stop.quiet_time, or no damage began before stop.end_time.
  first_damage REAL, -- [s] Time when damage of a body with flaws began; off without damage. It is looked for at every eighth step, so it may be eight steps late.
  cease_time REAL, -- [s] Time when fracture ceased: damage has grown by less than stop.quiet_growth since. Off when fracture has not ceased.
  mean_damage REAL, -- [1] Mean damage D of the target at the end, weighted by mass.
  undamaged_fraction REAL, -- [1] Mass share of the target's particles with damage below fragments.damage. Particles that only the static strength breaks count as undamaged.
  largest_bare_fraction REAL, -- [1] M_1/M of the core: mass of the largest fragment without its damaged layer over the target's mass, with the static strength.
  largest_veneer_fraction REAL, -- [1] M_1/M: mass of the largest fragment with its damaged layer (veneer) over the target's mass, with the static strength.
  largest_dynamic_fraction REAL, -- [1] M_1/M with the damaged layer and without the static strength.
  largest_axis_middle REAL, -- [1] Middle over longest axis of the ellipsoid that has the moments of inertia of the largest fragment. Off when that has fewer than 100 particles.
  largest_axis_short REAL, -- [1] Shortest over longest axis of the same ellipsoid. 1 is a sphere.
  largest_speed REAL, -- [m/s] Speed of the largest fragment's centre of mass. Off when that has fewer than 100 particles.
  second_mass REAL, -- [kg] Mass of the second largest fragment; off when there is only one.
  second_angle REAL, -- [rad] Impact: angle between the directions from the centre of mass to the point of impact and to the second largest fragment. 180 deg is the antipode. Off when that has fewer than 100 particles.
  fragments_shaped INTEGER, -- [1] Number of fragments of at least 60 particles, without the largest: those whose shapes count.
  fragments_b_over_a REAL, -- [1] Middle over longest length of fragments of at least 60 particles, without the largest: the mean over the fragments. Lengths are the axes of the solid ellipsoid with the fragment's moments of inertia. Off without such a fragment.
  fragments_c_over_a REAL, -- [1] Shortest over longest length of the same fragments.
  ejecta_mass_fraction REAL, -- [1] Impact: mass share of the target leaving faster than crater.ejection_speed and crater.escape_speed. Times target_mass: their mass. `clast spectrum STORE --ejecta` shows it over the speed.
  ejecta_momentum REAL, -- [kg m/s] Impact: momentum of the ejecta along the outward normal.
  ejecta_momentum_enhancement REAL, -- [1] Impact: 1 plus the momentum of the ejecta, and of matter of the projectile that moves outwards, over that of the projectile, along the normal: what the rest of the target gains, over what the projectile brings. Ejecta are faster than crater.ejection_speed; all matter counts that is faster than crater.escape_speed.
  crater_depth REAL, -- [m] Impact: largest depth of the crater below the surface at the start, along the outward normal at the point of impact. 0 when it is less than the spacing of the particles.
  crater_radius REAL, -- [m] Impact: radius of a circle whose area is that of the crater at the surface.
  crater_volume REAL, -- [m^3] Impact: volume of the crater, between the surface at the start and the surface of the retained matter.
  crater_compaction_share REAL, -- [1] Impact: volume lost by compaction over the sum of that volume and the ejecta's volume at the start. 1 is a crater made by compaction alone. Off when both volumes are 0.
  energy_kinetic REAL, -- [J] Kinetic energy at the end.
  energy_internal REAL, -- [J] Internal energy at the end, elastic energy included.
  energy_damped REAL, -- [J] Energy that the damping layer of a box took out of motion (sides.far: damped); 0 in all other scenes.
  energy_work_of_held REAL, -- [J] Work done on the body by matter that is held at a given velocity: the grips of a stretch, the piston; 0 in all other scenes.
  energy_clamped REAL, -- [J] Energy added where internal energy would have become negative.
  energy_input REAL, -- [J] Energy put in: kinetic energy at the start plus the absolute value of energy.work_of_held.
  clamped_share REAL, -- [1] energy.clamped over the energy put in, without that of the motion of all matter together. energy_error does not subtract it.
  density_held_share REAL, -- [1] Share of all particle steps that held the density at its lower limit. Such a step adds no energy.
  angular_momentum_error REAL, -- [1] Relative change of angular momentum; off with grips, a piston or a damping layer. The scale is the larger of the angular momentum at the start and the sum of momenta (the larger of start and end) times the target's extent. Only axes count across which nothing is periodic.
  limited_courant REAL, -- [1] Share of the steps limited by the speed of sound and viscosity, or by a damped side.
  limited_force REAL, -- [1] Share of the steps limited by the acceleration.
  limited_energy REAL, -- [1] Share of the steps limited by the change of internal energy.
  limited_density REAL, -- [1] Share of the steps limited by the change of density.
  limited_distention REAL, -- [1] Share of the steps limited by the closing of pores.
  limited_damage REAL, -- [1] Share of the steps limited by the growth of damage.
  neighbours REAL, -- [1] Mean number of neighbours within 2h at the end.
  peak_stress REAL, -- [Pa] Stretch: largest mean axial stress between the grips.
  peak_strain REAL, -- [1] Stretch: strain (strain rate times time) at the largest stress.
  peak_time REAL, -- [s] Stretch: time of the largest stress.
  cracks REAL, -- [1] Stretch: number of parts of more than 1 % of the rod's mass, minus one. Parts are found without static strength and without damaged layers. Overlapping cracks joined by broken rock do not count, even if the rod no longer carries load.
  frequency REAL, -- [1/s] Vibration: frequency of the first mode, from its zero crossings.
  rebound REAL, -- [1] Collision: speed of separation of the bodies over their speed of approach.
  shock_speed REAL, -- [m/s] Piston: speed of the shock (behind a precursor: of the crushing front) over the second half of the run. The front is where density passes the mean of the values ahead and behind. Off when the piston is too slow for a shock. Of no use, and maybe below 0, with the warning arrival.
  shock_speed_exact REAL, -- [m/s] Piston: speed of the shock by the jump conditions.
  shock_density REAL, -- [kg/m^3] Piston: mean density behind the shock, in the middle half between piston and shock.
  shock_density_exact REAL, -- [kg/m^3] Piston: density behind the shock by the jump conditions.
  shock_pressure REAL, -- [Pa] Piston: mean pressure behind the shock, in the same region.
  shock_pressure_exact REAL, -- [Pa] Piston: pressure behind the shock by the jump conditions.
  precursor_speed REAL, -- [m/s] Piston: speed of the elastic precursor, which runs ahead of the crushing front; off where there is none, and when the shock is faster. Of no use, and maybe below 0, with the warning arrival.
  precursor_speed_exact REAL, -- [m/s] Piston: speed of the precursor by the jump conditions.
  precursor_pressure REAL, -- [Pa] Piston: mean pressure between precursor and shock.
  precursor_pressure_exact REAL, -- [Pa] Piston: exact pressure behind the precursor: that at which pores begin to close, or less when the piston is slow.
  mean_distention REAL, -- [1] Mean distention of the target at the end, weighted by mass, at zero pressure. 1 is solid; off without pores.
  compaction_mass_fraction REAL, -- [1] Impact: mass share of the target that was compacted: its distention at zero pressure fell from 1.01 or more to below 1.01. Off without pores.
  compaction_volume REAL, -- [m^3] Impact: volume that the retained matter lost as its pores closed; off without pores.
  compaction_depth REAL, -- [m] Impact: depth at the start of the deepest compacted particle near the axis; off without pores.
  compaction_reach REAL, -- [m] Impact: largest distance from the point of impact at which matter lost a hundredth of its pores; off without pores.
  shock_distention REAL, -- [1] Piston: mean distention behind the shock, in the same region; off without pores.
  shock_distention_exact REAL, -- [1] Piston: distention behind the shock by the jump conditions and the crush curve.
  precursor_distention REAL, -- [1] Piston: mean distention between precursor and shock.
  precursor_distention_exact REAL, -- [1] Piston: distention behind the precursor on the elastic branch.
  energy_contact REAL -- [J] Energy of the overlap of bodies in contact at the end. Off with method.contact: welded.
) STRICT;

CREATE VIEW runs AS -- every run with its varied inputs and all results of its engine
SELECT r.run_id, r.point_id, p.engine, p.scene_name AS scene, r.replicate, r.seed,
  (EXISTS (SELECT 1 FROM campaign WHERE NOT ifnull(document LIKE '# Written by clast %', 0)) AND p.point_id NOT IN (SELECT point_id FROM campaign_point JOIN campaign USING (campaign_id) WHERE NOT ifnull(document LIKE '# Written by clast %', 0)) AND (p.point_id IN (SELECT point_id FROM campaign_point) OR NOT EXISTS (SELECT 1 FROM run AS x WHERE x.point_id = p.point_id))) AS study,
  "r"."session_id" AS "session_id",
  "r"."results_version" AS "results_version",
  "r"."surplus" AS "surplus",
  "r"."attempt" AS "attempt",
  "r"."wall_time" AS "wall_time",
  "r"."cpu_time" AS "cpu_time",
  "r"."peak_memory" AS "peak_memory",
  "r"."host" AS "host",
  "r"."rank" AS "rank",
  "r"."finished_at" AS "finished_at",
  "r"."fields_path" AS "fields_path",
  "r"."excluded" AS "excluded",
  "r"."excluded_at" AS "excluded_at",
  "r"."counts" AS "counts",
  "r"."state" AS "state",
  "r"."message" AS "message",
  "r"."warnings" AS "warnings",
  "r"."steps" AS "steps",
  "r"."time" AS "time",
  "r"."time_step" AS "time_step",
  "r"."total_mass" AS "total_mass",
  "r"."energy_error" AS "energy_error",
  "r"."momentum_error" AS "momentum_error",
  "r"."fragment_count" AS "fragment_count",
  "r"."single_count" AS "single_count",
  (SELECT "r"."dust_fraction" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', dust,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,')))) IS NOT TRUE) AS "dust_fraction",
  "r"."complete_mass" AS "complete_mass",
  (SELECT "r"."largest_fraction" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,')))) IS NOT TRUE) AS "largest_fraction",
  (SELECT "r"."second_fraction" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,')))) IS NOT TRUE) AS "second_fraction",
  "r"."mean_fragment_mass" AS "mean_fragment_mass",
  "r"."mean_fragment_mass_rest" AS "mean_fragment_mass_rest",
  "r"."kinetic_energy_share" AS "kinetic_energy_share",
  "result_dem"."stop_reason" AS "result_dem_stop_reason",
  "result_dem"."grains" AS "grains",
  "result_dem"."beams" AS "beams",
  "result_dem"."broken" AS "broken",
  "result_dem"."broken_stretch" AS "broken_stretch",
  "result_dem"."broken_bend" AS "broken_bend",
  "result_dem"."broken_share" AS "broken_share",
  "result_dem"."first_break" AS "first_break",
  "result_dem"."last_break" AS "last_break",
  "result_dem"."energy_input" AS "result_dem_energy_input",
  "result_dem"."threshold_energy" AS "threshold_energy",
  "result_dem"."stable_time_step" AS "stable_time_step",
  "result_dem"."sound_speed_extension" AS "sound_speed_extension",
  "result_dem"."sound_speed_compression" AS "sound_speed_compression",
  "result_dem"."overlap_share" AS "overlap_share",
  "result_dem"."passing_share" AS "passing_share",
  "result_dem"."angular_momentum_error" AS "result_dem_angular_momentum_error",
  "result_dem"."late_breaks" AS "late_breaks",
  "result_dem"."largest_loss" AS "largest_loss",
  "result_dem"."energy_kinetic" AS "result_dem_energy_kinetic",
  "result_dem"."energy_vibration" AS "energy_vibration",
  "result_dem"."energy_beam" AS "energy_beam",
  "result_dem"."energy_contact" AS "result_dem_energy_contact",
  "result_dem"."energy_damping" AS "energy_damping",
  "result_dem"."energy_friction" AS "energy_friction",
  "result_dem"."energy_broken_beam" AS "energy_broken_beam",
  "result_dem"."energy_external_work" AS "energy_external_work",
  (SELECT "result_dem"."young_modulus" WHERE (r.warnings <> '' AND (p.engine = 'dem' AND (instr(', ' || r.warnings || ',', ', broken,')))) IS NOT TRUE) AS "young_modulus",
  (SELECT "result_dem"."poisson_ratio" WHERE (r.warnings <> '' AND (p.engine = 'dem' AND (instr(', ' || r.warnings || ',', ', broken,')))) IS NOT TRUE) AS "poisson_ratio",
  (SELECT "result_dem"."strength" WHERE (r.warnings <> '' AND (p.engine = 'dem' AND (instr(', ' || r.warnings || ',', ', event,') OR instr(', ' || r.warnings || ',', ', elastic,')))) IS NOT TRUE) AS "strength",
  (SELECT "result_dem"."failure_strain" WHERE (r.warnings <> '' AND (p.engine = 'dem' AND (instr(', ' || r.warnings || ',', ', event,') OR instr(', ' || r.warnings || ',', ', elastic,')))) IS NOT TRUE) AS "failure_strain",
  "result_dem"."final_strain" AS "final_strain",
  (SELECT "result_dem"."upright_share" WHERE (r.warnings <> '' AND (p.engine = 'dem' AND (instr(', ' || r.warnings || ',', ', event,')))) IS NOT TRUE) AS "upright_share",
  (SELECT "result_dem"."end_triangle_share" WHERE (r.warnings <> '' AND (p.engine = 'dem' AND (instr(', ' || r.warnings || ',', ', event,')))) IS NOT TRUE) AS "end_triangle_share",
  "result_sph"."stop_reason" AS "result_sph_stop_reason",
  "result_sph"."particles" AS "particles",
  "result_sph"."projectile_particles" AS "projectile_particles",
  "result_sph"."flaws" AS "flaws",
  "result_sph"."target_mass" AS "target_mass",
  "result_sph"."projectile_mass" AS "projectile_mass",
  "result_sph"."specific_energy" AS "specific_energy",
  "result_sph"."fracture_ceased" AS "fracture_ceased",
  "result_sph"."first_damage" AS "first_damage",
  "result_sph"."cease_time" AS "cease_time",
  (SELECT "result_sph"."mean_damage" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,')))) IS NOT TRUE) AS "mean_damage",
  (SELECT "result_sph"."undamaged_fraction" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,')))) IS NOT TRUE) AS "undamaged_fraction",
  (SELECT "result_sph"."largest_bare_fraction" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,')))) IS NOT TRUE) AS "largest_bare_fraction",
  (SELECT "result_sph"."largest_veneer_fraction" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,')))) IS NOT TRUE) AS "largest_veneer_fraction",
  (SELECT "result_sph"."largest_dynamic_fraction" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,')))) IS NOT TRUE) AS "largest_dynamic_fraction",
  "result_sph"."largest_axis_middle" AS "largest_axis_middle",
  "result_sph"."largest_axis_short" AS "largest_axis_short",
  "result_sph"."largest_speed" AS "largest_speed",
  "result_sph"."second_mass" AS "second_mass",
  "result_sph"."second_angle" AS "second_angle",
  "result_sph"."fragments_shaped" AS "fragments_shaped",
  (SELECT "result_sph"."fragments_b_over_a" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', shapes,')))) IS NOT TRUE) AS "fragments_b_over_a",
  (SELECT "result_sph"."fragments_c_over_a" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', shapes,')))) IS NOT TRUE) AS "fragments_c_over_a",
  "result_sph"."ejecta_mass_fraction" AS "ejecta_mass_fraction",
  "result_sph"."ejecta_momentum" AS "ejecta_momentum",
  (SELECT "result_sph"."ejecta_momentum_enhancement" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', flown,')))) IS NOT TRUE) AS "ejecta_momentum_enhancement",
  (SELECT "result_sph"."crater_depth" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', moved,') OR instr(', ' || r.warnings || ',', ', wide,') OR instr(', ' || r.warnings || ',', ', gone,')))) IS NOT TRUE) AS "crater_depth",
  (SELECT "result_sph"."crater_radius" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', moved,') OR instr(', ' || r.warnings || ',', ', wide,') OR instr(', ' || r.warnings || ',', ', gone,')))) IS NOT TRUE) AS "crater_radius",
  (SELECT "result_sph"."crater_volume" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', moved,') OR instr(', ' || r.warnings || ',', ', wide,') OR instr(', ' || r.warnings || ',', ', gone,')))) IS NOT TRUE) AS "crater_volume",
  (SELECT "result_sph"."crater_compaction_share" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', moved,') OR instr(', ' || r.warnings || ',', ', wide,') OR instr(', ' || r.warnings || ',', ', gone,')))) IS NOT TRUE) AS "crater_compaction_share",
  "result_sph"."energy_kinetic" AS "result_sph_energy_kinetic",
  "result_sph"."energy_internal" AS "energy_internal",
  "result_sph"."energy_damped" AS "energy_damped",
  "result_sph"."energy_work_of_held" AS "energy_work_of_held",
  "result_sph"."energy_clamped" AS "energy_clamped",
  "result_sph"."energy_input" AS "result_sph_energy_input",
  "result_sph"."clamped_share" AS "clamped_share",
  "result_sph"."density_held_share" AS "density_held_share",
  "result_sph"."angular_momentum_error" AS "result_sph_angular_momentum_error",
  "result_sph"."limited_courant" AS "limited_courant",
  "result_sph"."limited_force" AS "limited_force",
  "result_sph"."limited_energy" AS "limited_energy",
  "result_sph"."limited_density" AS "limited_density",
  "result_sph"."limited_distention" AS "limited_distention",
  "result_sph"."limited_damage" AS "limited_damage",
  "result_sph"."neighbours" AS "neighbours",
  (SELECT "result_sph"."peak_stress" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', event,')))) IS NOT TRUE) AS "peak_stress",
  (SELECT "result_sph"."peak_strain" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', event,')))) IS NOT TRUE) AS "peak_strain",
  (SELECT "result_sph"."peak_time" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', event,')))) IS NOT TRUE) AS "peak_time",
  "result_sph"."cracks" AS "cracks",
  (SELECT "result_sph"."frequency" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', amplitude,') OR instr(', ' || r.warnings || ',', ', cracked,') OR instr(', ' || r.warnings || ',', ', samples,') OR instr(', ' || r.warnings || ',', ', uneven,')))) IS NOT TRUE) AS "frequency",
  (SELECT "result_sph"."rebound" WHERE (r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', apart,')))) IS NOT TRUE) AS "rebound",
  "result_sph"."shock_speed" AS "shock_speed",
  "result_sph"."shock_speed_exact" AS "shock_speed_exact",
  "result_sph"."shock_density" AS "shock_density",
  "result_sph"."shock_density_exact" AS "shock_density_exact",
  "result_sph"."shock_pressure" AS "shock_pressure",
  "result_sph"."shock_pressure_exact" AS "shock_pressure_exact",
  "result_sph"."precursor_speed" AS "precursor_speed",
  "result_sph"."precursor_speed_exact" AS "precursor_speed_exact",
  "result_sph"."precursor_pressure" AS "precursor_pressure",
  "result_sph"."precursor_pressure_exact" AS "precursor_pressure_exact",
  "result_sph"."mean_distention" AS "mean_distention",
  "result_sph"."compaction_mass_fraction" AS "compaction_mass_fraction",
  "result_sph"."compaction_volume" AS "compaction_volume",
  "result_sph"."compaction_depth" AS "compaction_depth",
  "result_sph"."compaction_reach" AS "compaction_reach",
  "result_sph"."shock_distention" AS "shock_distention",
  "result_sph"."shock_distention_exact" AS "shock_distention_exact",
  "result_sph"."precursor_distention" AS "precursor_distention",
  "result_sph"."precursor_distention_exact" AS "precursor_distention_exact",
  "result_sph"."energy_contact" AS "result_sph_energy_contact",
  r.warnings NOT IN ('', 'elastic', 'shapes') AS doubtful,
  lower(hex(r.identity)) AS identity
FROM run r JOIN point p ON p.point_id = r.point_id
  LEFT JOIN "result_dem" ON "result_dem".run_id = r.run_id
  LEFT JOIN "result_sph" ON "result_sph".run_id = r.run_id;

CREATE VIEW points AS -- statistics of every point, one row per results_version
WITH first AS (
  SELECT k.largest_fraction AS k0, k.second_fraction AS k1, k.fragment_count AS k2, k.dust_fraction AS k3, k.mean_fragment_mass AS k4, t.point_id, t.results_version
  FROM point_total t JOIN run k ON k.run_id = (SELECT f.run_id FROM run f WHERE f.point_id =
    t.point_id AND f.results_version = t.results_version AND f.counts = 1 ORDER BY f.replicate, f.seed LIMIT 1)
), away AS (
  SELECT f.point_id, f.results_version,
    iif(r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,'))), NULL, r.largest_fraction - k0) AS a0, k0,
    iif(r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,'))), NULL, r.second_fraction - k1) AS a1, k1,
    iif(0, NULL, r.fragment_count - k2) AS a2, k2,
    iif(r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', dust,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,'))), NULL, r.dust_fraction - k3) AS a3, k3,
    iif(0, NULL, r.mean_fragment_mass - k4) AS a4, k4
  FROM first f CROSS JOIN run r ON r.point_id = f.point_id AND r.results_version = f.results_version AND
    r.counts = 1 CROSS JOIN point p ON p.point_id = f.point_id
), moment AS (
  SELECT point_id, results_version,
    k0, count(a0) AS n0, total(a0) AS s0, total(a0 * a0) AS q0, max(abs(a0)) AS x0,
    k1, count(a1) AS n1, total(a1) AS s1, total(a1 * a1) AS q1, max(abs(a1)) AS x1,
    k2, count(a2) AS n2, total(a2) AS s2, total(a2 * a2) AS q2, max(abs(a2)) AS x2,
    k3, count(a3) AS n3, total(a3) AS s3, total(a3 * a3) AS q3, max(abs(a3)) AS x3,
    k4, count(a4) AS n4, total(a4) AS s4, total(a4 * a4) AS q4, max(abs(a4)) AS x4
  FROM away GROUP BY point_id, results_version
), scatter AS (
  SELECT *,
    k0 + s0 / n0 AS m0, iif(x0 > 1e150 OR (x0 < 1e-130 AND x0 > 0), NULL, sqrt(max(0, (q0 - s0 * s0 / n0) / (n0 - 1)))) AS d0,
    CASE WHEN (n0 - 1) = 1 THEN 12.706204736174 WHEN (n0 - 1) = 2 THEN 4.302652729749 WHEN (n0 - 1) = 3 THEN 3.182446305284 WHEN (n0 - 1) = 4 THEN 2.776445105198 WHEN (n0 - 1) = 5 THEN 2.570581835636 WHEN (n0 - 1) = 6 THEN 2.446911851145 WHEN (n0 - 1) = 7 THEN 2.364624251593 WHEN (n0 - 1) = 8 THEN 2.306004135204 WHEN (n0 - 1) = 9 THEN 2.262157162798 WHEN (n0 - 1) = 10 THEN 2.228138851986
      WHEN (n0 - 1) > 10 THEN 1.959963984540 + (2.372271230299 + (2.822498615740 + (2.555849679508 + 1.589534053394 / (n0 - 1)) / (n0 - 1)) / (n0 - 1)) / (n0 - 1) END AS t0,
    k1 + s1 / n1 AS m1, iif(x1 > 1e150 OR (x1 < 1e-130 AND x1 > 0), NULL, sqrt(max(0, (q1 - s1 * s1 / n1) / (n1 - 1)))) AS d1,
    CASE WHEN (n1 - 1) = 1 THEN 12.706204736174 WHEN (n1 - 1) = 2 THEN 4.302652729749 WHEN (n1 - 1) = 3 THEN 3.182446305284 WHEN (n1 - 1) = 4 THEN 2.776445105198 WHEN (n1 - 1) = 5 THEN 2.570581835636 WHEN (n1 - 1) = 6 THEN 2.446911851145 WHEN (n1 - 1) = 7 THEN 2.364624251593 WHEN (n1 - 1) = 8 THEN 2.306004135204 WHEN (n1 - 1) = 9 THEN 2.262157162798 WHEN (n1 - 1) = 10 THEN 2.228138851986
      WHEN (n1 - 1) > 10 THEN 1.959963984540 + (2.372271230299 + (2.822498615740 + (2.555849679508 + 1.589534053394 / (n1 - 1)) / (n1 - 1)) / (n1 - 1)) / (n1 - 1) END AS t1,
    k2 + s2 / n2 AS m2, iif(x2 > 1e150 OR (x2 < 1e-130 AND x2 > 0), NULL, sqrt(max(0, (q2 - s2 * s2 / n2) / (n2 - 1)))) AS d2,
    CASE WHEN (n2 - 1) = 1 THEN 12.706204736174 WHEN (n2 - 1) = 2 THEN 4.302652729749 WHEN (n2 - 1) = 3 THEN 3.182446305284 WHEN (n2 - 1) = 4 THEN 2.776445105198 WHEN (n2 - 1) = 5 THEN 2.570581835636 WHEN (n2 - 1) = 6 THEN 2.446911851145 WHEN (n2 - 1) = 7 THEN 2.364624251593 WHEN (n2 - 1) = 8 THEN 2.306004135204 WHEN (n2 - 1) = 9 THEN 2.262157162798 WHEN (n2 - 1) = 10 THEN 2.228138851986
      WHEN (n2 - 1) > 10 THEN 1.959963984540 + (2.372271230299 + (2.822498615740 + (2.555849679508 + 1.589534053394 / (n2 - 1)) / (n2 - 1)) / (n2 - 1)) / (n2 - 1) END AS t2,
    k3 + s3 / n3 AS m3, iif(x3 > 1e150 OR (x3 < 1e-130 AND x3 > 0), NULL, sqrt(max(0, (q3 - s3 * s3 / n3) / (n3 - 1)))) AS d3,
    CASE WHEN (n3 - 1) = 1 THEN 12.706204736174 WHEN (n3 - 1) = 2 THEN 4.302652729749 WHEN (n3 - 1) = 3 THEN 3.182446305284 WHEN (n3 - 1) = 4 THEN 2.776445105198 WHEN (n3 - 1) = 5 THEN 2.570581835636 WHEN (n3 - 1) = 6 THEN 2.446911851145 WHEN (n3 - 1) = 7 THEN 2.364624251593 WHEN (n3 - 1) = 8 THEN 2.306004135204 WHEN (n3 - 1) = 9 THEN 2.262157162798 WHEN (n3 - 1) = 10 THEN 2.228138851986
      WHEN (n3 - 1) > 10 THEN 1.959963984540 + (2.372271230299 + (2.822498615740 + (2.555849679508 + 1.589534053394 / (n3 - 1)) / (n3 - 1)) / (n3 - 1)) / (n3 - 1) END AS t3,
    k4 + s4 / n4 AS m4, iif(x4 > 1e150 OR (x4 < 1e-130 AND x4 > 0), NULL, sqrt(max(0, (q4 - s4 * s4 / n4) / (n4 - 1)))) AS d4,
    CASE WHEN (n4 - 1) = 1 THEN 12.706204736174 WHEN (n4 - 1) = 2 THEN 4.302652729749 WHEN (n4 - 1) = 3 THEN 3.182446305284 WHEN (n4 - 1) = 4 THEN 2.776445105198 WHEN (n4 - 1) = 5 THEN 2.570581835636 WHEN (n4 - 1) = 6 THEN 2.446911851145 WHEN (n4 - 1) = 7 THEN 2.364624251593 WHEN (n4 - 1) = 8 THEN 2.306004135204 WHEN (n4 - 1) = 9 THEN 2.262157162798 WHEN (n4 - 1) = 10 THEN 2.228138851986
      WHEN (n4 - 1) > 10 THEN 1.959963984540 + (2.372271230299 + (2.822498615740 + (2.555849679508 + 1.589534053394 / (n4 - 1)) / (n4 - 1)) / (n4 - 1)) / (n4 - 1) END AS t4
  FROM moment
), width AS (
  SELECT *,
    iif(d0 > 1e-14 * abs(m0), t0 * d0 / sqrt(n0) * (1 + 0.375 * min(sqrt(n0), d0 / max(min(m0, 1 - m0), 1e-300)) * min(1, sqrt(25.0 / n0))), NULL) AS h0,
    iif(d1 > 1e-14 * abs(m1), t1 * d1 / sqrt(n1) * (1 + 0.375 * min(sqrt(n1), d1 / max(min(m1, 1 - m1), 1e-300)) * min(1, sqrt(25.0 / n1))), NULL) AS h1,
    iif(d2 > 1e-14 * abs(m2), t2 * d2 / sqrt(n2), NULL) AS h2,
    iif(d3 > 1e-14 * abs(m3), t3 * d3 / sqrt(n3) * (1 + 0.375 * min(sqrt(n3), d3 / max(min(m3, 1 - m3), 1e-300)) * min(1, sqrt(25.0 / n3))), NULL) AS h3,
    iif(d4 > 1e-14 * abs(m4), t4 * d4 / sqrt(n4), NULL) AS h4
  FROM scatter
)
, unresolved AS MATERIALIZED (SELECT point_id, results_version,
    max(iif('largest_fraction' IN (quantity, 'result_' || engine || '_' || quantity), half_width, NULL)) AS e0, max(iif('largest_fraction' IN (quantity, 'result_' || engine || '_' || quantity), verdict, NULL)) AS v0,
    max(iif('second_fraction' IN (quantity, 'result_' || engine || '_' || quantity), half_width, NULL)) AS e1, max(iif('second_fraction' IN (quantity, 'result_' || engine || '_' || quantity), verdict, NULL)) AS v1,
    max(iif('fragment_count' IN (quantity, 'result_' || engine || '_' || quantity), half_width, NULL)) AS e2, max(iif('fragment_count' IN (quantity, 'result_' || engine || '_' || quantity), verdict, NULL)) AS v2,
    max(iif('dust_fraction' IN (quantity, 'result_' || engine || '_' || quantity), half_width, NULL)) AS e3, max(iif('dust_fraction' IN (quantity, 'result_' || engine || '_' || quantity), verdict, NULL)) AS v3,
    max(iif('mean_fragment_mass' IN (quantity, 'result_' || engine || '_' || quantity), half_width, NULL)) AS e4, max(iif('mean_fragment_mass' IN (quantity, 'result_' || engine || '_' || quantity), verdict, NULL)) AS v4
  FROM resolution JOIN point USING (point_id) GROUP BY point_id, results_version)
SELECT p.point_id, p.engine, p.scene_name AS scene,
  (EXISTS (SELECT 1 FROM campaign WHERE NOT ifnull(document LIKE '# Written by clast %', 0)) AND p.point_id NOT IN (SELECT point_id FROM campaign_point JOIN campaign USING (campaign_id) WHERE NOT ifnull(document LIKE '# Written by clast %', 0)) AND (p.point_id IN (SELECT point_id FROM campaign_point) OR NOT EXISTS (SELECT 1 FROM run AS x WHERE x.point_id = p.point_id))) AS study,
  t.results_version, ifnull(t.runs, 0) AS n, ifnull(t.censored, 0) AS censored,
  ifnull(t.failed, 0) + iif(t.results_version < (SELECT max(v.results_version) FROM point_total v WHERE v.point_id = p.point_id), 0, iif(1 AND p.point_id IN (SELECT point_id FROM attempt), (SELECT count(*) FROM (SELECT a.seed FROM (SELECT max(iif(x.surplus & 1, NULL, x.replicate)) AS last, max(x.surplus & 1) AS ruled FROM run x WHERE x.point_id = p.point_id) CROSS JOIN attempt a WHERE a.point_id = p.point_id AND a.reason <> 'lost' AND (ruled IS NOT 1 OR a.replicate <= last) EXCEPT SELECT x.seed FROM run x WHERE x.point_id = p.point_id)), 0)) AS failed,
  ifnull(t.surplus, 0) AS surplus, (SELECT count(*) FROM run r WHERE r.point_id = t.point_id AND r.results_version = t.results_version AND r.counts = 0 AND r.surplus > 1) AS excluded, (SELECT count(*) FROM attempt a WHERE a.point_id = p.point_id) AS failed_attempts,
  (SELECT count(*) FROM run r WHERE r.point_id = t.point_id AND r.results_version = t.results_version AND r.counts AND r.warnings NOT IN ('', 'elastic', 'shapes')) AS doubtful,
  ifnull((SELECT group_concat(words, '; ') FROM (SELECT DISTINCT r.warnings AS words FROM run r WHERE r.point_id = t.point_id AND r.results_version = t.results_version AND r.counts AND r.warnings NOT IN ('', 'elastic', 'shapes') ORDER BY words)), '') AS doubts,
  m0 AS "largest_fraction_mean", d0 AS "largest_fraction_sd", d0 / sqrt(n0) AS "largest_fraction_se", h0 AS "largest_fraction_hw95",
  iif(h0 IS NULL, iif(n0 > 1, m0 * pow(0.05, 1.0 / n0), NULL), max(m0 - h0, 0.0)) AS "largest_fraction_low95",
  iif(h0 IS NULL, iif(n0 > 1, 1 - (1 - m0) * pow(0.05, 1.0 / n0), NULL), min(m0 + h0, 1.0)) AS "largest_fraction_high95",
  iif(h0 IS NULL, NULL, (n0 < 40 AND d0 < 0.045 * max(m0, 1 - m0)) OR (n0 < 20 AND d0 < 0.14 * max(m0, 1 - m0) AND d0 > 0.4 * min(m0, 1 - m0))) AS "largest_fraction_weak",
  e0 AS "largest_fraction_resolution", ifnull(v0, 'not-studied') AS "largest_fraction_resolution_verdict",
  m1 AS "second_fraction_mean", d1 AS "second_fraction_sd", d1 / sqrt(n1) AS "second_fraction_se", h1 AS "second_fraction_hw95",
  iif(h1 IS NULL, iif(n1 > 1, m1 * pow(0.05, 1.0 / n1), NULL), max(m1 - h1, 0.0)) AS "second_fraction_low95",
  iif(h1 IS NULL, iif(n1 > 1, 1 - (1 - m1) * pow(0.05, 1.0 / n1), NULL), min(m1 + h1, 1.0)) AS "second_fraction_high95",
  iif(h1 IS NULL, NULL, (n1 < 40 AND d1 < 0.045 * max(m1, 1 - m1)) OR (n1 < 20 AND d1 < 0.14 * max(m1, 1 - m1) AND d1 > 0.4 * min(m1, 1 - m1))) AS "second_fraction_weak",
  e1 AS "second_fraction_resolution", ifnull(v1, 'not-studied') AS "second_fraction_resolution_verdict",
  m2 AS "fragment_count_mean", d2 AS "fragment_count_sd", d2 / sqrt(n2) AS "fragment_count_se", h2 AS "fragment_count_hw95",
  max(m2 - h2, 0 + 0.0) AS "fragment_count_low95", m2 + h2 AS "fragment_count_high95", NULL AS "fragment_count_weak",
  e2 AS "fragment_count_resolution", ifnull(v2, 'not-studied') AS "fragment_count_resolution_verdict",
  m3 AS "dust_fraction_mean", d3 AS "dust_fraction_sd", d3 / sqrt(n3) AS "dust_fraction_se", h3 AS "dust_fraction_hw95",
  iif(h3 IS NULL, iif(n3 > 1, m3 * pow(0.05, 1.0 / n3), NULL), max(m3 - h3, 0.0)) AS "dust_fraction_low95",
  iif(h3 IS NULL, iif(n3 > 1, 1 - (1 - m3) * pow(0.05, 1.0 / n3), NULL), min(m3 + h3, 1.0)) AS "dust_fraction_high95",
  iif(h3 IS NULL, NULL, (n3 < 40 AND d3 < 0.045 * max(m3, 1 - m3)) OR (n3 < 20 AND d3 < 0.14 * max(m3, 1 - m3) AND d3 > 0.4 * min(m3, 1 - m3))) AS "dust_fraction_weak",
  e3 AS "dust_fraction_resolution", ifnull(v3, 'not-studied') AS "dust_fraction_resolution_verdict",
  m4 AS "mean_fragment_mass_mean", d4 AS "mean_fragment_mass_sd", d4 / sqrt(n4) AS "mean_fragment_mass_se", h4 AS "mean_fragment_mass_hw95",
  max(m4 - h4, 0 + 0.0) AS "mean_fragment_mass_low95", m4 + h4 AS "mean_fragment_mass_high95", NULL AS "mean_fragment_mass_weak",
  e4 AS "mean_fragment_mass_resolution", ifnull(v4, 'not-studied') AS "mean_fragment_mass_resolution_verdict"
FROM point p NOT INDEXED LEFT JOIN point_total t ON t.point_id = p.point_id
  LEFT JOIN width s ON s.point_id = t.point_id AND s.results_version = t.results_version
  LEFT JOIN unresolved u ON u.point_id = t.point_id AND u.results_version = t.results_version;

CREATE VIEW spectra AS -- pooled fragment mass spectrum of every point
SELECT p.point_id, p.engine, p.scene_name AS scene,
  (EXISTS (SELECT 1 FROM campaign WHERE NOT ifnull(document LIKE '# Written by clast %', 0)) AND p.point_id NOT IN (SELECT point_id FROM campaign_point JOIN campaign USING (campaign_id) WHERE NOT ifnull(document LIKE '# Written by clast %', 0)) AND (p.point_id IN (SELECT point_id FROM campaign_point) OR NOT EXISTS (SELECT 1 FROM run AS x WHERE x.point_id = p.point_id))) AS study,
  s.results_version, t.runs AS n, s.bin, b.lower, b.upper, s.runs, s.count, s.mass,
  1.0 * s.count / t.runs AS count_mean,
  sqrt(max(0, (s.count_squared - 1.0 * s.count * s.count / t.runs) / (t.runs - 1))) AS count_sd,
  (CASE WHEN (t.runs - 1) = 1 THEN 12.706204736174 WHEN (t.runs - 1) = 2 THEN 4.302652729749 WHEN (t.runs - 1) = 3 THEN 3.182446305284 WHEN (t.runs - 1) = 4 THEN 2.776445105198 WHEN (t.runs - 1) = 5 THEN 2.570581835636 WHEN (t.runs - 1) = 6 THEN 2.446911851145 WHEN (t.runs - 1) = 7 THEN 2.364624251593 WHEN (t.runs - 1) = 8 THEN 2.306004135204 WHEN (t.runs - 1) = 9 THEN 2.262157162798 WHEN (t.runs - 1) = 10 THEN 2.228138851986
      WHEN (t.runs - 1) > 10 THEN 1.959963984540 + (2.372271230299 + (2.822498615740 + (2.555849679508 + 1.589534053394 / (t.runs - 1)) / (t.runs - 1)) / (t.runs - 1)) / (t.runs - 1) END) * sqrt(nullif(max(0, (s.count_squared - 1.0 * s.count * s.count / t.runs) / (t.runs - 1) / t.runs), 0)) AS count_hw95,
  s.count / (t.fragments * (b.upper - b.lower)) AS density
FROM point p JOIN point_total t ON t.point_id = p.point_id
  JOIN point_spectrum s ON s.point_id = t.point_id AND s.results_version = t.results_version
  JOIN bin b ON b.bin = s.bin;

CREATE VIEW estimates AS -- estimates of runs (run_id) and of whole points (run_id NULL)
SELECT e.point_id, e.run_id, e.replicate, e.seed, e.counts, p.engine, p.scene_name AS scene,
  (EXISTS (SELECT 1 FROM campaign WHERE NOT ifnull(document LIKE '# Written by clast %', 0)) AND p.point_id NOT IN (SELECT point_id FROM campaign_point JOIN campaign USING (campaign_id) WHERE NOT ifnull(document LIKE '# Written by clast %', 0)) AND (p.point_id IN (SELECT point_id FROM campaign_point) OR NOT EXISTS (SELECT 1 FROM run AS x WHERE x.point_id = p.point_id))) AS study,
  "ordinal", "window", "method", "headline", "lower", "upper", "n", "beta", "standard_error", "hw95", "cutoff_mass", "ks_distance", "log_likelihood", 
  CASE WHEN e.run_id IS NOT NULL THEN NULL WHEN e.n < 5 THEN 'fewer than 5 fragments'
    WHEN e.beta IS NULL THEN iif(e.method = 'least_squares', 'a bin without a fragment', 'fewer than 5 different masses')
    WHEN e.hw95 IS NULL THEN iif(e.standard_error < 1, NULL, 'no interval and a standard error of 1 or more')
    WHEN e.hw95 >= 2 THEN 'an interval of ± 2 or wider' END AS untold,
  e.results_version
FROM (
  SELECT r.point_id, r.run_id, r.replicate, r.seed, r.counts, "ordinal", "window", "method", "headline", "lower", "upper", "n", "beta", "standard_error", "hw95", "cutoff_mass", "ks_distance", "log_likelihood", r.results_version
  FROM estimate JOIN run r USING (run_id)
  UNION ALL
  SELECT point_id, NULL, NULL, NULL, NULL, "ordinal", "window", "method", "headline", "lower", "upper", "n", "beta", "standard_error", "hw95", "cutoff_mass", "ks_distance", "log_likelihood", results_version FROM point_estimate
) e JOIN point p ON p.point_id = e.point_id;

CREATE VIEW resolution AS -- what finer settings may change in a result, for every point that was studied
WITH share (quantity) AS (VALUES ('dust_fraction'), ('largest_fraction'), ('second_fraction'), ('broken_share'), ('largest_loss'), ('upright_share'), ('mean_damage'), ('undamaged_fraction'), ('largest_bare_fraction'), ('largest_veneer_fraction'), ('largest_dynamic_fraction'), ('largest_axis_middle'), ('largest_axis_short'), ('fragments_b_over_a'), ('fragments_c_over_a'), ('ejecta_mass_fraction'), ('crater_compaction_share'), ('density_held_share'), ('limited_courant'), ('limited_force'), ('limited_energy'), ('limited_density'), ('limited_distention'), ('limited_damage'), ('compaction_mass_fraction')),
of_runs AS MATERIALIZED (SELECT point_id, r.results_version, 'dust_fraction' AS quantity, avg(iif(r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', dust,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,'))), NULL, r.dust_fraction)) AS mean
    FROM run r JOIN point p USING (point_id) WHERE r.counts = 1 AND point_id IN
      (SELECT point_id FROM convergence WHERE quantity = 'dust_fraction') GROUP BY point_id, r.results_version
  UNION ALL SELECT point_id, r.results_version, 'largest_fraction' AS quantity, avg(iif(r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,'))), NULL, r.largest_fraction)) AS mean
    FROM run r JOIN point p USING (point_id) WHERE r.counts = 1 AND point_id IN
      (SELECT point_id FROM convergence WHERE quantity = 'largest_fraction') GROUP BY point_id, r.results_version
  UNION ALL SELECT point_id, r.results_version, 'second_fraction' AS quantity, avg(iif(r.warnings <> '' AND (p.engine = 'sph' AND (instr(', ' || r.warnings || ',', ', liquid,') OR instr(', ' || r.warnings || ',', ', box,') OR instr(', ' || r.warnings || ',', ', hot,'))), NULL, r.second_fraction)) AS mean
    FROM run r JOIN point p USING (point_id) WHERE r.counts = 1 AND point_id IN
      (SELECT point_id FROM convergence WHERE quantity = 'second_fraction') GROUP BY point_id, r.results_version),
-- A newer SQLite takes no more than a thousand uses of such tables in a question, with those inside of them: what needs
-- the keys alone takes `studied`.
studied AS (SELECT * FROM convergence WHERE (resolution IS NOT NULL OR open) AND knob <> 'settings'),
row AS MATERIALIZED (SELECT *, coalesce(step, 1.0 / setting) AS size, -- numbers without a step: finer is larger
    abs(coalesce(distance, bias)) / resolution AS middle -- of its interval: what more seeds leave, as a share
  FROM studied),
finest AS MATERIALIZED (SELECT * FROM row WHERE reference AND n > 0),
-- What a law of order 0.5 leaves beyond the finest level, by the changes from coarser ones.
past AS MATERIALIZED (SELECT base_point_id, results_version, quantity, knob, count(*) AS coarser,
    max((abs(r.bias) + r.bias_half_width) / (sqrt(r.size / f.size) - 1)) AS beyond
  FROM row r JOIN finest f USING (base_point_id, results_version, quantity, knob)
  WHERE r.n > 0 AND r.size > f.size GROUP BY base_point_id, results_version, quantity, knob),
level AS MATERIALIZED (SELECT r.*, f.setting AS finest_setting, ifnull(p.coarser, 0) AS coarser,
    iif(NOT r.open, 0, iif(r.n > 0 OR r.size < f.size, p.beyond, NULL)) AS beyond,
    r.resolution * coalesce(min(r.middle, 1), iif(r.open, 1, min(f.middle, 1)), 1) AS left_by_seeds
  FROM row r LEFT JOIN finest f USING (base_point_id, results_version, quantity, knob)
    LEFT JOIN past p USING (base_point_id, results_version, quantity, knob)),
of_knob AS MATERIALIZED (SELECT base_point_id, results_version, quantity, knob, max(resolution) AS largest,
    max(verdict IN ('no-limit', 'no-order')) AS diverges, max(n) AS seeds, max(finest_setting) AS finest_setting,
    max(coarser) AS coarser, coalesce(min(iif(n > 0, size, NULL)), 9e999) AS finest,
    sign(total(size) * total(setting) - count(*) * total(size * setting)) AS up -- 1: larger settings are finer
  FROM level LEFT JOIN convergence_limit USING (base_point_id, results_version, knob, quantity)
  GROUP BY base_point_id, results_version, quantity, knob),
-- main: the input that is the setting; the others of the knob follow it.
knob_path AS MATERIALIZED (SELECT l.base_point_id, l.knob, i.path,
    min(abs(i.value - l.setting) <= 1e-5 * abs(i.value)) AS main
  FROM studied l JOIN point_input i ON i.point_id = l.point_id
    LEFT JOIN point_input b ON b.point_id = l.base_point_id AND b.path = i.path WHERE i.value IS NOT b.value
  GROUP BY l.base_point_id, l.knob, i.path),
-- A point belongs to a study if it differs from the scene studied in settings of knobs only, and if it is the one with
-- which the study compares its named settings.
scene AS MATERIALIZED (SELECT point_id, group_concat(path || quote(value)) AS inputs
  FROM (SELECT point_id, path, value FROM point_input
    WHERE point_id IN (SELECT point_id FROM studied UNION SELECT base_point_id FROM studied)
      AND path NOT IN (SELECT path FROM knob_path) ORDER BY point_id, path)
  GROUP BY point_id),
kin AS (SELECT p.point_id, s.base_point_id
  FROM (SELECT DISTINCT base_point_id FROM studied) s JOIN scene b ON b.point_id = s.base_point_id
    JOIN scene p USING (inputs)
  UNION SELECT point_id, base_point_id FROM convergence WHERE knob = 'settings' AND reference),
-- Of several studies of a knob the one with the finest level tells its errors, of those the one with most seeds.
placed AS (SELECT *, rank() OVER (PARTITION BY point_id, results_version, quantity, knob ORDER BY finest, seeds DESC)
    AS place
  FROM kin JOIN of_knob USING (base_point_id)),
-- The inputs of a knob at a point, and the one that is its setting.
at AS MATERIALIZED (SELECT base_point_id, knob, point_id, max(iif(main, value, NULL)) AS place,
    group_concat(quote(value)) AS inputs
  FROM (SELECT q.*, k.point_id, n.value FROM kin k JOIN knob_path q USING (base_point_id)
      LEFT JOIN point_input n ON n.point_id = k.point_id AND n.path = q.path ORDER BY k.point_id, q.path)
  GROUP BY base_point_id, knob, point_id),
-- The level that tells the error of a point: the one with its setting, else the next coarser one, whose error is no
-- smaller. Coarser than all levels, or a choice that is none of them: the largest error counts, which is no bound.
chosen AS (SELECT p.*, min(l.size), l.resolution, l.left_by_seeds, l.open, l.beyond
  FROM placed p LEFT JOIN at a USING (base_point_id, knob, point_id)
    LEFT JOIN (SELECT l.*, t.inputs FROM level l LEFT JOIN at t USING (base_point_id, knob, point_id)
      WHERE resolution IS NOT NULL) l
    ON (l.base_point_id, l.results_version, l.quantity, l.knob) = (p.base_point_id, p.results_version, p.quantity, p.knob)
      AND (l.inputs IS a.inputs OR p.up * (a.place - l.setting) > 0)
  WHERE p.place = 1
  GROUP BY p.point_id, p.base_point_id, p.results_version, p.quantity, p.knob),
left_by AS MATERIALIZED (SELECT point_id, results_version, quantity, knob,
    max(coalesce(resolution, largest)) AS error, max(diverges) AS diverges,
    max(iif(largest IS NULL, 2, coalesce(open, 1))) AS open,
    iif(count(beyond) = count(*), max(beyond), NULL) AS beyond,
    max(coalesce(left_by_seeds, largest)) AS left_by_seeds, min(coarser) AS coarser,
    max(finest_setting) AS finest, max(seeds) AS seeds
  FROM chosen GROUP BY point_id, results_version, quantity, knob),
-- Other named settings, unless they are a level of a knob: the parts of their reference, and how far they are from it.
named AS MATERIALIZED (SELECT s.point_id, s.results_version, s.quantity, r.point_id AS reference,
    max(abs(s.bias) + s.bias_half_width) AS error, max(abs(s.bias)) AS left_by_seeds, max(s.n) AS seeds
  FROM convergence s JOIN convergence r USING (base_point_id, results_version, quantity, knob)
  WHERE s.knob = 'settings' AND r.reference AND NOT s.base AND NOT s.reference AND s.bias_half_width IS NOT NULL
    AND (r.base_point_id, r.results_version, r.quantity) IN (SELECT base_point_id, results_version, quantity
      FROM studied WHERE resolution IS NOT NULL)
    AND (s.point_id, s.results_version, s.quantity) NOT IN (SELECT point_id, results_version, quantity FROM studied)
  GROUP BY s.point_id, s.results_version, s.quantity),
part AS (SELECT * FROM left_by
    WHERE (point_id, results_version, quantity) NOT IN (SELECT point_id, results_version, quantity FROM named)
  UNION ALL SELECT n.point_id, n.results_version, n.quantity, l.knob, l.error, l.diverges, l.open, l.beyond,
    l.left_by_seeds, l.coarser, l.finest, l.seeds
  FROM named n JOIN left_by l ON l.point_id = n.reference AND l.results_version = n.results_version
    AND l.quantity = n.quantity
  UNION ALL SELECT point_id, results_version, quantity, 'settings', error, 0, 0, 0, left_by_seeds, 0, NULL, seeds
    FROM named),
whole AS (SELECT point_id, results_version, quantity, sum(error) AS error, max(diverges) AS diverges,
    max(open) AS open, iif(quantity IN (SELECT quantity FROM share), coalesce((SELECT max(r.mean, 1 - r.mean)
      FROM of_runs r WHERE (r.point_id, r.results_version, r.quantity) = (p.point_id, p.results_version, p.quantity)),
    (SELECT max(r.mean, 1 - r.mean)
      FROM convergence c JOIN convergence r USING (base_point_id, results_version, quantity, knob)
      WHERE c.point_id = p.point_id AND c.results_version = p.results_version AND c.quantity = p.quantity
      AND r.mean IS NOT NULL AND iif(c.mean IS NULL, r.reference, r.point_id = c.point_id) -- finer than any run: as the finest
      ORDER BY c.mean IS NULL, r.n DESC LIMIT 1), 1), 9e999) AS most
  FROM part p GROUP BY point_id, results_version, quantity HAVING sum(error) IS NOT NULL),
-- The error of a setting, on every screen. No error of a share is larger than `most`, its distance from the farther end
-- of 0 to 1. A knob that never ran tells nothing.
told AS (SELECT point_id, results_version, quantity, min(error, most) AS half_width,
    CASE WHEN error > most THEN 'known' WHEN diverges THEN 'diverges' WHEN NOT open THEN 'known'
      WHEN error = 0 THEN 'no-difference' ELSE 'at-least' END AS verdict
  FROM whole WHERE error > 0 OR open < 2)SELECT * FROM told;

INSERT INTO column_doc VALUES ('attempt', 'attempt_id', NULL, 'number of the failed attempt', 0);

INSERT INTO column_doc VALUES ('attempt', 'exit_code', NULL, 'exit code of the process', 0);

INSERT INTO column_doc VALUES ('attempt', 'failed_at', 's', 'when, seconds since 1970-01-01 UTC', 0);

INSERT INTO column_doc VALUES ('attempt', 'host', NULL, 'machine', 0);

INSERT INTO column_doc VALUES ('attempt', 'identity', NULL, 'identity of the run that was tried', 0);

INSERT INTO column_doc VALUES ('attempt', 'limited_to', NULL, 'the limit that ended it: seconds or bytes, 0 for the other reasons', 0);

INSERT INTO column_doc VALUES ('attempt', 'message', NULL, 'its message', 0);

INSERT INTO column_doc VALUES ('attempt', 'number', NULL, 'which attempt, from 1', 0);

INSERT INTO column_doc VALUES ('attempt', 'peak_memory', 'B', 'largest resident memory', 0);

INSERT INTO column_doc VALUES ('attempt', 'point_id', NULL, 'its point', 0);

INSERT INTO column_doc VALUES ('attempt', 'rank', NULL, 'MPI rank', 0);

INSERT INTO column_doc VALUES ('attempt', 'reason', NULL, 'time_limit, memory_limit, crash, lost or exit', 0);

INSERT INTO column_doc VALUES ('attempt', 'replicate', NULL, 'which seed of the point, from 0', 0);

INSERT INTO column_doc VALUES ('attempt', 'seed', NULL, 'the seed (64 bits, shown as a signed number)', 0);

INSERT INTO column_doc VALUES ('attempt', 'session_id', NULL, 'the session that tried', 0);

INSERT INTO column_doc VALUES ('attempt', 'signal', NULL, 'signal that ended it, 0 for none', 0);

INSERT INTO column_doc VALUES ('attempt', 'wall_time', 's', 'elapsed time', 0);

INSERT INTO column_doc VALUES ('axis', 'column_name', NULL, 'its column in the views', 0);

INSERT INTO column_doc VALUES ('axis', 'meaning', NULL, 'what the input means', 0);

INSERT INTO column_doc VALUES ('axis', 'path', NULL, 'path of an input that some campaign varied', 0);

INSERT INTO column_doc VALUES ('axis', 'unit', NULL, 'SI unit of the input', 0);

INSERT INTO column_doc VALUES ('axis', 'written_unit', NULL, 'unit of its values in the campaign: that of tables for people; NULL: SI', 0);

INSERT INTO column_doc VALUES ('bin', 'bin', NULL, 'number of a mass bin: ten per decade, bin 0 starts at 1 kg', 0);

INSERT INTO column_doc VALUES ('bin', 'lower', 'kg', 'lower edge, inside the bin', 0);

INSERT INTO column_doc VALUES ('bin', 'upper', 'kg', 'upper edge, outside the bin', 0);

INSERT INTO column_doc VALUES ('campaign', 'added_at', NULL, 'when it was first run, UTC, ISO 8601', 0);

INSERT INTO column_doc VALUES ('campaign', 'campaign_id', NULL, 'number of the campaign in this store', 0);

INSERT INTO column_doc VALUES ('campaign', 'document', NULL, 'the campaign file as it was read', 0);

INSERT INTO column_doc VALUES ('campaign', 'name', NULL, 'its name', 0);

INSERT INTO column_doc VALUES ('campaign', 'plan', NULL, 'the resolved plan, JSON', 0);

INSERT INTO column_doc VALUES ('campaign_point', 'campaign_id', NULL, 'a campaign with this point', 0);

INSERT INTO column_doc VALUES ('campaign_point', 'point_id', NULL, 'a point of it; campaigns may share points', 0);

INSERT INTO column_doc VALUES ('column_doc', 'column_name', NULL, 'column of it', 0);

INSERT INTO column_doc VALUES ('column_doc', 'deterministic', NULL, '1: a result that depends on inputs, seed and results_version alone (not a time, a host...)', 0);

INSERT INTO column_doc VALUES ('column_doc', 'meaning', NULL, 'what the column holds', 0);

INSERT INTO column_doc VALUES ('column_doc', 'table_name', NULL, 'table or view', 0);

INSERT INTO column_doc VALUES ('column_doc', 'unit', NULL, 'SI unit; NULL where there is none', 0);

INSERT INTO column_doc VALUES ('convergence', 'base', NULL, '1: the scene''s own setting.', 1);

INSERT INTO column_doc VALUES ('convergence', 'base_point_id', NULL, 'the scene studied, as a point', 0);

INSERT INTO column_doc VALUES ('convergence', 'bias', NULL, 'Mean of this level less that of the reference.', 1);

INSERT INTO column_doc VALUES ('convergence', 'bias_half_width', NULL, 'Half width of the 95 % interval of the bias.', 1);

INSERT INTO column_doc VALUES ('convergence', 'break_even', NULL, '2 sqrt(w)/(1 + w): correlation from which a control variate would save time.', 1);

INSERT INTO column_doc VALUES ('convergence', 'correlation', NULL, 'Pearson''s correlation over seeds with the next finer level.', 1);

INSERT INTO column_doc VALUES ('convergence', 'correlation_high', NULL, 'Upper end of it.', 1);

INSERT INTO column_doc VALUES ('convergence', 'correlation_low', NULL, 'Lower end of its 95 % interval (Fisher).', 1);

INSERT INTO column_doc VALUES ('convergence', 'cost_ratio', NULL, 'w: processor time of a run over that of the next finer level.', 1);

INSERT INTO column_doc VALUES ('convergence', 'cpu', 's', 'Mean processor time of a run.', 1);

INSERT INTO column_doc VALUES ('convergence', 'deviation', NULL, 'Standard deviation between seeds.', 1);

INSERT INTO column_doc VALUES ('convergence', 'distance', NULL, 'Mean less its limit: the middle of the 95 % interval. Off: no limit is seen.', 1);

INSERT INTO column_doc VALUES ('convergence', 'distance_half_width', NULL, 'Half width of that interval.', 1);

INSERT INTO column_doc VALUES ('convergence', 'error', NULL, 'What all knobs of group resolution together leave unknown at this level: half_width of the view resolution after the last study. Off where it is not known.', 1);

INSERT INTO column_doc VALUES ('convergence', 'frontier', NULL, '1: no other level of the scene here has an error and a cpu that are both not larger, and one of them smaller (Pareto).', 1);

INSERT INTO column_doc VALUES ('convergence', 'gain', NULL, 'Plain Monte Carlo''s cost over that of the best control variate; 1: it saves nothing.', 1);

INSERT INTO column_doc VALUES ('convergence', 'half_width', NULL, 'Half width of the 95 % interval of the mean (Student''s t).', 1);

INSERT INTO column_doc VALUES ('convergence', 'knob', NULL, 'What was made coarser or finer (`clast converge --list`).', 1);

INSERT INTO column_doc VALUES ('convergence', 'level', NULL, 'number of the level, from 0, coarse to fine', 0);

INSERT INTO column_doc VALUES ('convergence', 'mean', NULL, 'Mean over seeds.', 1);

INSERT INTO column_doc VALUES ('convergence', 'n', '1', 'Seeds with a usable result.', 1);

INSERT INTO column_doc VALUES ('convergence', 'open', NULL, '1: no limit is in sight, so that resolution may be larger; with 0: no run differs.', 1);

INSERT INTO column_doc VALUES ('convergence', 'paired', NULL, '1: levels are compared seed by seed.', 1);

INSERT INTO column_doc VALUES ('convergence', 'point_id', NULL, 'the level, as a point: its runs are in run', 0);

INSERT INTO column_doc VALUES ('convergence', 'quantity', NULL, 'Result, as a column of the view runs. Its unit is that of mean, bias and error.', 1);

INSERT INTO column_doc VALUES ('convergence', 'reference', NULL, '1: the finest level, or the choice that the others are compared with.', 1);

INSERT INTO column_doc VALUES ('convergence', 'resolution', NULL, 'What this knob leaves unknown at this level: the largest distance to the limit in its interval, or |bias| and half width where no limit is seen; 0 where all runs are equal. Off for knobs that are no resolution.', 1);

INSERT INTO column_doc VALUES ('convergence', 'results_version', NULL, 'version of the engine''s results', 0);

INSERT INTO column_doc VALUES ('convergence', 'setting', NULL, 'Value of the knob''s first input at this level.', 1);

INSERT INTO column_doc VALUES ('convergence', 'skew', NULL, 'Skewness over seeds. Off for fewer than 20.', 1);

INSERT INTO column_doc VALUES ('convergence', 'step', NULL, 'Size that goes to zero as the knob gets finer, such as particles^(-1/3). Off: none.', 1);

INSERT INTO column_doc VALUES ('convergence', 'upper_mode', NULL, 'Share of the runs in the upper of two modes (`clast scatter`). Off: one mode.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'base_point_id', NULL, 'the scene studied, as a point', 0);

INSERT INTO column_doc VALUES ('convergence_limit', 'change', NULL, 'Mean of the finest level less that of the next coarser one.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'change_high', NULL, 'Upper end of it.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'change_low', NULL, 'Lower end of its 95 % interval.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'dropped', '1', 'Coarse levels that the law does not describe.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'extrapolated', NULL, 'Value at step 0: mean over the laws, by their likelihood.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'extrapolated_high', NULL, 'Upper end of it.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'extrapolated_low', NULL, 'Lower end of its 95 % interval over all laws.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'fit', NULL, 'Share of the samples of the best law that lie farther from it than the levels; below 0.05 no law fits.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'fit_with', NULL, 'The same with the finest of the dropped levels. Off: none is dropped.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'knob', NULL, 'What was made coarser or finer.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'measured_order', NULL, 'p of limit + a step^p that fits best.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'measured_order_high', NULL, 'Upper end of it, 3 at most.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'measured_order_low', NULL, 'Lower end of its 95 % interval, 0.5 at least.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'one_power_high', NULL, 'Upper end of it.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'one_power_low', NULL, 'Lower end of the interval of the laws with one power alone: two errors against each other are left out. Off: the levels reject one power.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'quantity', NULL, 'Result, as a column of the view runs. Its unit is that of the limit.', 1);

INSERT INTO column_doc VALUES ('convergence_limit', 'results_version', NULL, 'version of the engine''s results', 0);

INSERT INTO column_doc VALUES ('convergence_limit', 'verdict', NULL, 'What all levels and seeds together tell. One of: too-few, constant, limit, no-limit, falling', 1);

INSERT INTO column_doc VALUES ('ejecta', 'bin', NULL, 'number of a bin of speed: ten per decade, bin 0 starts at 1 m/s', 0);

INSERT INTO column_doc VALUES ('ejecta', 'mass', 'kg', 'mass of the target''s matter that leaves at such a speed (result ejecta.mass_fraction)', 0);

INSERT INTO column_doc VALUES ('ejecta', 'momentum', 'kg m/s', 'its momentum along the outward normal (result ejecta.momentum)', 0);

INSERT INTO column_doc VALUES ('ejecta', 'run_id', NULL, 'the run', 0);

INSERT INTO column_doc VALUES ('ejecta', 'speed', 'm/s', 'lower edge of the bin, inside it; only bins that hold something', 0);

INSERT INTO column_doc VALUES ('estimate', 'beta', '1', 'Exponent of F(m) ~ m^-beta, fragments per unit mass (differential; the cumulative slope is beta - 1). Off when there are too few fragments.', 1);

INSERT INTO column_doc VALUES ('estimate', 'cutoff_mass', 'kg', 'm_c of m^-beta exp(-m/m_c); method cutoff only. Off when the pure power law fits best.', 1);

INSERT INTO column_doc VALUES ('estimate', 'headline', NULL, '1: the estimate that is called beta, by maximum likelihood on masses of at least 5 elements (grains or particles), without the largest fragment.', 1);

INSERT INTO column_doc VALUES ('estimate', 'hw95', '1', 'Half width of the 95 % interval of beta over the runs (seeds) of a point: Student''s t and the jackknife. Off for one run. It does not hold the error of the resolution.', 1);

INSERT INTO column_doc VALUES ('estimate', 'ks_distance', '1', 'Largest distance between the distribution functions of sample and fit; method masses only.', 1);

INSERT INTO column_doc VALUES ('estimate', 'log_likelihood', '1', 'Natural logarithm of the likelihood of ln(m). Compare within one window only.', 1);

INSERT INTO column_doc VALUES ('estimate', 'lower', 'kg', 'Lower end of the window used (2D: kg per metre of thickness).', 1);

INSERT INTO column_doc VALUES ('estimate', 'method', NULL, 'Method of the estimate. One of: least_squares, masses, cutoff', 1);

INSERT INTO column_doc VALUES ('estimate', 'n', '1', 'Fragments in the window.', 1);

INSERT INTO column_doc VALUES ('estimate', 'ordinal', NULL, 'number among the estimates of the run', 0);

INSERT INTO column_doc VALUES ('estimate', 'run_id', NULL, 'the run', 0);

INSERT INTO column_doc VALUES ('estimate', 'standard_error', '1', 'Standard error of beta. Of one run: fragments are taken as independent, which they are not; it is no interval over seeds. Of a point: from leaving out one of its runs after another (jackknife), and as of one run where this gives no interval.', 1);

INSERT INTO column_doc VALUES ('estimate', 'upper', 'kg', 'Upper end, not part of the window: the mass of the largest fragment, or a bin edge. With least_squares a decade above the lower end.', 1);

INSERT INTO column_doc VALUES ('estimate', 'window', NULL, 'Window of masses of the estimate. None begins below complete_mass of the run. One of: from_2, from_5, from_10', 1);

INSERT INTO column_doc VALUES ('estimates', 'beta', '1', 'Exponent of F(m) ~ m^-beta, fragments per unit mass (differential; the cumulative slope is beta - 1). Off when there are too few fragments.', 0);

INSERT INTO column_doc VALUES ('estimates', 'counts', NULL, '1: part of the statistics (not surplus or excluded, completed or ended at its time, the main results are numbers)', 0);

INSERT INTO column_doc VALUES ('estimates', 'cutoff_mass', 'kg', 'm_c of m^-beta exp(-m/m_c); method cutoff only. Off when the pure power law fits best.', 0);

INSERT INTO column_doc VALUES ('estimates', 'engine', NULL, 'name of the engine', 0);

INSERT INTO column_doc VALUES ('estimates', 'headline', NULL, '1: the estimate that is called beta, by maximum likelihood on masses of at least 5 elements (grains or particles), without the largest fragment.', 0);

INSERT INTO column_doc VALUES ('estimates', 'hw95', '1', 'Half width of the 95 % interval of beta over the runs (seeds) of a point: Student''s t and the jackknife. Off for one run. It does not hold the error of the resolution.', 0);

INSERT INTO column_doc VALUES ('estimates', 'ks_distance', '1', 'Largest distance between the distribution functions of sample and fit; method masses only.', 0);

INSERT INTO column_doc VALUES ('estimates', 'log_likelihood', '1', 'Natural logarithm of the likelihood of ln(m). Compare within one window only.', 0);

INSERT INTO column_doc VALUES ('estimates', 'lower', 'kg', 'lower edge, inside the bin', 0);

INSERT INTO column_doc VALUES ('estimates', 'method', NULL, 'Method of the estimate. One of: least_squares, masses, cutoff', 0);

INSERT INTO column_doc VALUES ('estimates', 'n', '1', 'Fragments in the window.', 0);

INSERT INTO column_doc VALUES ('estimates', 'ordinal', NULL, 'number among the estimates of the run', 0);

INSERT INTO column_doc VALUES ('estimates', 'point_id', NULL, 'the point', 0);

INSERT INTO column_doc VALUES ('estimates', 'replicate', NULL, 'which seed of the point, from 0', 0);

INSERT INTO column_doc VALUES ('estimates', 'results_version', NULL, 'version of the engine''s results', 0);

INSERT INTO column_doc VALUES ('estimates', 'run_id', NULL, 'the run', 0);

INSERT INTO column_doc VALUES ('estimates', 'scene', NULL, 'name of the scene the inputs started from', 0);

INSERT INTO column_doc VALUES ('estimates', 'seed', NULL, 'the seed (64 bits, shown as a signed number)', 0);

INSERT INTO column_doc VALUES ('estimates', 'standard_error', '1', 'Standard error of beta. Of one run: fragments are taken as independent, which they are not; it is no interval over seeds. Of a point: from leaving out one of its runs after another (jackknife), and as of one run where this gives no interval.', 0);

INSERT INTO column_doc VALUES ('estimates', 'study', NULL, '1: only studies and searches (clast converge, find, ...) asked for the point; 0 also in a store without other campaigns', 0);

INSERT INTO column_doc VALUES ('estimates', 'untold', NULL, 'of a point: why tables show no beta, whose whole number is not known; NULL: they show it', 0);

INSERT INTO column_doc VALUES ('estimates', 'upper', 'kg', 'upper edge, outside the bin', 0);

INSERT INTO column_doc VALUES ('estimates', 'window', NULL, 'Window of masses of the estimate. None begins below complete_mass of the run. One of: from_2, from_5, from_10', 0);

INSERT INTO column_doc VALUES ('fragment_mass', 'lengths', 'm', 'three lengths of each fragment, longest first, in the order of the masses up to the last that was measured, 0 for others: little-endian float64; NULL: none was measured', 0);

INSERT INTO column_doc VALUES ('fragment_mass', 'masses', 'kg', 'mass of every fragment, descending: little-endian float64, 8 bytes each', 0);

INSERT INTO column_doc VALUES ('fragment_mass', 'run_id', NULL, 'the run', 0);

INSERT INTO column_doc VALUES ('holder', 'holder_id', NULL, 'always 1', 0);

INSERT INTO column_doc VALUES ('holder', 'host', NULL, 'machine of the process that last opened the store for writing', 0);

INSERT INTO column_doc VALUES ('holder', 'pid', NULL, 'its process number; the row only names the holder, the store is held by an OS lock', 0);

INSERT INTO column_doc VALUES ('holder', 'since', NULL, 'when it did, UTC, ISO 8601', 0);

INSERT INTO column_doc VALUES ('point', 'digest', NULL, 'changes when any bit of the point or its inputs changes', 0);

INSERT INTO column_doc VALUES ('point', 'engine', NULL, 'name of the engine', 0);

INSERT INTO column_doc VALUES ('point', 'hash', NULL, '128-bit hash of engine and active inputs, without seed and results_version', 0);

INSERT INTO column_doc VALUES ('point', 'point_id', NULL, 'number of the point: one set of input values', 0);

INSERT INTO column_doc VALUES ('point', 'scene', NULL, 'the resolved scene, JSON, SI units: every active input, defaults too', 0);

INSERT INTO column_doc VALUES ('point', 'scene_name', NULL, 'name of the scene the inputs started from', 0);

INSERT INTO column_doc VALUES ('point_estimate', 'beta', '1', 'Exponent of F(m) ~ m^-beta, fragments per unit mass (differential; the cumulative slope is beta - 1). Off when there are too few fragments.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'cutoff_mass', 'kg', 'm_c of m^-beta exp(-m/m_c); method cutoff only. Off when the pure power law fits best.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'headline', NULL, '1: the estimate that is called beta, by maximum likelihood on masses of at least 5 elements (grains or particles), without the largest fragment.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'hw95', '1', 'Half width of the 95 % interval of beta over the runs (seeds) of a point: Student''s t and the jackknife. Off for one run. It does not hold the error of the resolution.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'ks_distance', '1', 'Largest distance between the distribution functions of sample and fit; method masses only.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'log_likelihood', '1', 'Natural logarithm of the likelihood of ln(m). Compare within one window only.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'lower', 'kg', 'Lower end of the window used (2D: kg per metre of thickness).', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'method', NULL, 'Method of the estimate. One of: least_squares, masses, cutoff', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'n', '1', 'Fragments in the window.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'ordinal', NULL, 'number among the estimates of the point', 0);

INSERT INTO column_doc VALUES ('point_estimate', 'point_id', NULL, 'the point', 0);

INSERT INTO column_doc VALUES ('point_estimate', 'results_version', NULL, 'version of the engine''s results it was made from', 0);

INSERT INTO column_doc VALUES ('point_estimate', 'standard_error', '1', 'Standard error of beta. Of one run: fragments are taken as independent, which they are not; it is no interval over seeds. Of a point: from leaving out one of its runs after another (jackknife), and as of one run where this gives no interval.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'upper', 'kg', 'Upper end, not part of the window: the mass of the largest fragment, or a bin edge. With least_squares a decade above the lower end.', 1);

INSERT INTO column_doc VALUES ('point_estimate', 'window', NULL, 'Window of masses of the estimate. None begins below complete_mass of the run. One of: from_2, from_5, from_10', 1);

INSERT INTO column_doc VALUES ('point_input', 'path', NULL, 'path of an active input in the scene', 0);

INSERT INTO column_doc VALUES ('point_input', 'point_id', NULL, 'the point', 0);

INSERT INTO column_doc VALUES ('point_input', 'value', NULL, 'its value in SI units; choices by name, booleans 0 or 1, the keyword off as text', 0);

INSERT INTO column_doc VALUES ('point_spectrum', 'bin', NULL, 'mass bin (table bin)', 0);

INSERT INTO column_doc VALUES ('point_spectrum', 'count', '1', 'sum of their counts', 0);

INSERT INTO column_doc VALUES ('point_spectrum', 'count_squared', '1', 'sum of the squares of their counts, for the scatter between runs', 0);

INSERT INTO column_doc VALUES ('point_spectrum', 'mass', 'kg', 'sum of their masses', 0);

INSERT INTO column_doc VALUES ('point_spectrum', 'point_id', NULL, 'the point', 0);

INSERT INTO column_doc VALUES ('point_spectrum', 'results_version', NULL, 'version of the engine''s results', 0);

INSERT INTO column_doc VALUES ('point_spectrum', 'runs', '1', 'runs that count and have a fragment in the bin', 0);

INSERT INTO column_doc VALUES ('point_total', 'censored', '1', 'runs that count and ended at their time: fragments may still have been breaking', 0);

INSERT INTO column_doc VALUES ('point_total', 'failed', '1', 'runs that gave no usable result (NaN, time step, energy, invalid)', 0);

INSERT INTO column_doc VALUES ('point_total', 'fragments', '1', 'fragments of the runs that count', 0);

INSERT INTO column_doc VALUES ('point_total', 'mass', 'kg', 'mass of these fragments', 0);

INSERT INTO column_doc VALUES ('point_total', 'point_id', NULL, 'the point', 0);

INSERT INTO column_doc VALUES ('point_total', 'results_version', NULL, 'version of the engine''s results', 0);

INSERT INTO column_doc VALUES ('point_total', 'runs', '1', 'runs that count: completed, or ended at their time, not surplus, not excluded', 0);

INSERT INTO column_doc VALUES ('point_total', 'surplus', '1', 'runs left out because a stopping rule decided without them', 0);

INSERT INTO column_doc VALUES ('points', 'censored', '1', 'runs that count and ended at their time: fragments may still have been breaking', 0);

INSERT INTO column_doc VALUES ('points', 'doubtful', '1', 'runs behind the means that break a condition: their values are in doubt, or have no meaning', 0);

INSERT INTO column_doc VALUES ('points', 'doubts', NULL, 'warnings of these runs, each different text once; clast explain WORD says what a word means', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_high95', '1', 'upper end of this interval; of a share also when all runs are equal to 14 digits: Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_hw95', '1', 'half width of the 95 % confidence interval of the mean; NULL: one run, or all are equal to 14 digits: Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_low95', '1', 'lower end of this interval; of a share also when all runs are equal to 14 digits: Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_mean', '1', 'mean over runs: Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_resolution', '1', 'how far finer settings may move the mean (view resolution): Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_resolution_verdict', NULL, 'known, no-difference, at-least, diverges, or not-studied: Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_sd', '1', 'standard deviation between runs: Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_se', '1', 'standard error of the mean: Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'dust_fraction_weak', '1', '1: too few runs of this kind for the interval of this share: Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('points', 'engine', NULL, 'name of the engine', 0);

INSERT INTO column_doc VALUES ('points', 'excluded', '1', 'runs that a person excluded (clast exclude)', 0);

INSERT INTO column_doc VALUES ('points', 'failed', '1', 'runs without a usable result: it is not finite or not valid, or every attempt died; of several results_version, the newest has those that died', 0);

INSERT INTO column_doc VALUES ('points', 'failed_attempts', '1', 'attempts that failed: limits, crashes, lost workers', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_high95', '1', 'upper end of this interval; of a share also when all runs are equal to 14 digits: Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_hw95', '1', 'half width of the 95 % confidence interval of the mean; NULL: one run, or all are equal to 14 digits: Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_low95', '1', 'lower end of this interval; of a share also when all runs are equal to 14 digits: Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_mean', '1', 'mean over runs: Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_resolution', '1', 'how far finer settings may move the mean (view resolution): Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_resolution_verdict', NULL, 'known, no-difference, at-least, diverges, or not-studied: Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_sd', '1', 'standard deviation between runs: Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_se', '1', 'standard error of the mean: Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'fragment_count_weak', '1', '1: too few runs of this kind for the interval of this share: Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_high95', '1', 'upper end of this interval; of a share also when all runs are equal to 14 digits: Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_hw95', '1', 'half width of the 95 % confidence interval of the mean; NULL: one run, or all are equal to 14 digits: Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_low95', '1', 'lower end of this interval; of a share also when all runs are equal to 14 digits: Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_mean', '1', 'mean over runs: Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_resolution', '1', 'how far finer settings may move the mean (view resolution): Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_resolution_verdict', NULL, 'known, no-difference, at-least, diverges, or not-studied: Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_sd', '1', 'standard deviation between runs: Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_se', '1', 'standard error of the mean: Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'largest_fraction_weak', '1', '1: too few runs of this kind for the interval of this share: Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_high95', 'kg', 'upper end of this interval; of a share also when all runs are equal to 14 digits: Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_hw95', 'kg', 'half width of the 95 % confidence interval of the mean; NULL: one run, or all are equal to 14 digits: Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_low95', 'kg', 'lower end of this interval; of a share also when all runs are equal to 14 digits: Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_mean', 'kg', 'mean over runs: Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_resolution', 'kg', 'how far finer settings may move the mean (view resolution): Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_resolution_verdict', NULL, 'known, no-difference, at-least, diverges, or not-studied: Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_sd', 'kg', 'standard deviation between runs: Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_se', 'kg', 'standard error of the mean: Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'mean_fragment_mass_weak', '1', '1: too few runs of this kind for the interval of this share: Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('points', 'n', '1', 'runs that count: completed, or ended at their time, not surplus, not excluded', 0);

INSERT INTO column_doc VALUES ('points', 'point_id', NULL, 'the point', 0);

INSERT INTO column_doc VALUES ('points', 'results_version', NULL, 'version of the engine''s results', 0);

INSERT INTO column_doc VALUES ('points', 'scene', NULL, 'name of the scene the inputs started from', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_high95', '1', 'upper end of this interval; of a share also when all runs are equal to 14 digits: Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_hw95', '1', 'half width of the 95 % confidence interval of the mean; NULL: one run, or all are equal to 14 digits: Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_low95', '1', 'lower end of this interval; of a share also when all runs are equal to 14 digits: Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_mean', '1', 'mean over runs: Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_resolution', '1', 'how far finer settings may move the mean (view resolution): Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_resolution_verdict', NULL, 'known, no-difference, at-least, diverges, or not-studied: Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_sd', '1', 'standard deviation between runs: Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_se', '1', 'standard error of the mean: Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'second_fraction_weak', '1', '1: too few runs of this kind for the interval of this share: Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('points', 'study', NULL, '1: only studies and searches (clast converge, find, ...) asked for the point; 0 also in a store without other campaigns', 0);

INSERT INTO column_doc VALUES ('points', 'surplus', '1', 'runs left out because a stopping rule decided without them', 0);

INSERT INTO column_doc VALUES ('resolution', 'half_width', NULL, 'how far finer settings may move the result, in its unit: all knobs that were studied', 0);

INSERT INTO column_doc VALUES ('resolution', 'point_id', NULL, 'the point: the scene of a study, or one of its levels', 0);

INSERT INTO column_doc VALUES ('resolution', 'quantity', NULL, 'the result, as a column of the view runs; beta or beta_METHOD_WINDOW: an exponent of all runs of a point', 0);

INSERT INTO column_doc VALUES ('resolution', 'results_version', NULL, 'version of the engine''s results that was studied', 0);

INSERT INTO column_doc VALUES ('resolution', 'verdict', NULL, 'known: half_width is a bound, which can be as large as the result; no-difference: all runs of the settings are equal; at-least: no limit is known yet, so that half_width may be too small; diverges: the result does not converge', 0);

INSERT INTO column_doc VALUES ('result_dem', 'angular_momentum_error', '1', 'Change of the angular momentum about the origin, over the larger of its value at the start and the sum of the momenta times half of the body''s size. Off for bodies between moving sides.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'beams', '1', 'Number of beams at the start, without those of the explosive grain.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'broken', '1', 'Beams broken.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'broken_bend', '1', 'Broken beams for which the bending term was the larger one.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'broken_share', '1', 'Broken beams over all beams.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'broken_stretch', '1', 'Broken beams for which the stretching term of the breaking rule was the larger one.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'end_triangle_share', '1', 'Compression: share of beams broken inside the two 45-degree triangles on the confined ends, over the same share outside them, up to the largest stress. 0 is intact triangles, 1 no pattern.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_beam', 'J/m', 'Energy stored in beams at the end.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_broken_beam', 'J/m', 'Energy of the beams when they broke: the energy of the new surfaces. With contact.bonded off, less what contacts store that begin with a break.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_contact', 'J/m', 'Energy stored in contacts at the end (printed law: work done on contacts, of which only a part can return).', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_damping', 'J/m', 'Energy taken by damping.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_external_work', 'J/m', 'Work done by moving boundaries.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_friction', 'J/m', 'Energy taken by friction.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_input', 'J/m', 'Energy put in: initial kinetic energy (collision: in the common frame), or the work of the load.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_kinetic', 'J/m', 'Kinetic energy at the end.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'energy_vibration', 'J/m', 'Part of the kinetic energy that is motion inside fragments: neither their translation nor their rotation. Without damping it does not decay, and breaks more beams.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'failure_strain', '1', 'Strain at the largest stress.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'final_strain', '1', 'Strain at the end of the loading.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'first_break', 's', 'Time of the first break; off when none broke.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'grains', '1', 'Number of grains, without the explosive one.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'largest_loss', '1', 'Loss of M_1/M of the largest fragment in the second half of the run''s time; 0 for a final run. Expect about as much in the next doubling of the time.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'last_break', 's', 'Time of the last break; off when none broke.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'late_breaks', '1', 'Beams broken in the second half of the run''s time.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'overlap_share', '1', 'Pairs of grains that overlap, at the end, over the pairs that were neighbours at the start. Above 1 if many grains overlap that were none.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'passing_share', '1', 'Fastest approach of two near grains that no beam joins and whose paths meet, over the speed at which they pass through each other. Above 1 the model has no answer for them. Off without contacts.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'poisson_ratio', '1', 'nu: minus the slope of lateral against axial strain.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'run_id', NULL, 'the run', 0);

INSERT INTO column_doc VALUES ('result_dem', 'sound_speed_compression', 'm/s', 'Estimate sqrt((E + Y sqrt(pi)/2)/rho): beams and contacts, aligned with the wave.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'sound_speed_extension', 'm/s', 'Estimate sqrt(E/rho): beams alone, aligned with the wave (the square lattice''s value).', 1);

INSERT INTO column_doc VALUES ('result_dem', 'stable_time_step', 's', 'Longest stable time step of the body as it starts: 2/omega_max for `verlet`, 0.54/omega_max for `gear`.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'stop_reason', NULL, 'Why the run ended. One of: running, quiet, end-time, strain, failure, fault', 1);

INSERT INTO column_doc VALUES ('result_dem', 'strength', 'Pa', 'Largest stress under load, at any time step.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'threshold_energy', 'J/m', 'Energy that would bring every beam, unbent, to its own threshold. Off without breaking.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'upright_share', '1', 'Compression: broken beams whose crack (the common side) lies within 30 degrees of the load''s direction, over all broken beams, up to the largest stress. Of isotropic sides it would be 1/3.', 1);

INSERT INTO column_doc VALUES ('result_dem', 'young_modulus', 'Pa', 'K: slope of stress against strain under uniaxial load, up to the first break.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'angular_momentum_error', '1', 'Relative change of angular momentum; off with grips, a piston or a damping layer. The scale is the larger of the angular momentum at the start and the sum of momenta (the larger of start and end) times the target''s extent. Only axes count across which nothing is periodic.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'cease_time', 's', 'Time when fracture ceased: damage has grown by less than stop.quiet_growth since. Off when fracture has not ceased.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'clamped_share', '1', 'energy.clamped over the energy put in, without that of the motion of all matter together. energy_error does not subtract it.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'compaction_depth', 'm', 'Impact: depth at the start of the deepest compacted particle near the axis; off without pores.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'compaction_mass_fraction', '1', 'Impact: mass share of the target that was compacted: its distention at zero pressure fell from 1.01 or more to below 1.01. Off without pores.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'compaction_reach', 'm', 'Impact: largest distance from the point of impact at which matter lost a hundredth of its pores; off without pores.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'compaction_volume', 'm^3', 'Impact: volume that the retained matter lost as its pores closed; off without pores.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'cracks', '1', 'Stretch: number of parts of more than 1 % of the rod''s mass, minus one. Parts are found without static strength and without damaged layers. Overlapping cracks joined by broken rock do not count, even if the rod no longer carries load.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'crater_compaction_share', '1', 'Impact: volume lost by compaction over the sum of that volume and the ejecta''s volume at the start. 1 is a crater made by compaction alone. Off when both volumes are 0.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'crater_depth', 'm', 'Impact: largest depth of the crater below the surface at the start, along the outward normal at the point of impact. 0 when it is less than the spacing of the particles.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'crater_radius', 'm', 'Impact: radius of a circle whose area is that of the crater at the surface.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'crater_volume', 'm^3', 'Impact: volume of the crater, between the surface at the start and the surface of the retained matter.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'density_held_share', '1', 'Share of all particle steps that held the density at its lower limit. Such a step adds no energy.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'ejecta_mass_fraction', '1', 'Impact: mass share of the target leaving faster than crater.ejection_speed and crater.escape_speed. Times target_mass: their mass. `clast spectrum STORE --ejecta` shows it over the speed.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'ejecta_momentum', 'kg m/s', 'Impact: momentum of the ejecta along the outward normal.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'ejecta_momentum_enhancement', '1', 'Impact: 1 plus the momentum of the ejecta, and of matter of the projectile that moves outwards, over that of the projectile, along the normal: what the rest of the target gains, over what the projectile brings. Ejecta are faster than crater.ejection_speed; all matter counts that is faster than crater.escape_speed.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'energy_clamped', 'J', 'Energy added where internal energy would have become negative.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'energy_contact', 'J', 'Energy of the overlap of bodies in contact at the end. Off with method.contact: welded.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'energy_damped', 'J', 'Energy that the damping layer of a box took out of motion (sides.far: damped); 0 in all other scenes.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'energy_input', 'J', 'Energy put in: kinetic energy at the start plus the absolute value of energy.work_of_held.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'energy_internal', 'J', 'Internal energy at the end, elastic energy included.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'energy_kinetic', 'J', 'Kinetic energy at the end.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'energy_work_of_held', 'J', 'Work done on the body by matter that is held at a given velocity: the grips of a stretch, the piston; 0 in all other scenes.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'first_damage', 's', 'Time when damage of a body with flaws began; off without damage. It is looked for at every eighth step, so it may be eight steps late.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'flaws', '1', 'Number of explicit flaws in all bodies.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'fracture_ceased', NULL, 'Fracture ceased by the rule of stop.quiet_time, or no damage began before stop.end_time.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'fragments_b_over_a', '1', 'Middle over longest length of fragments of at least 60 particles, without the largest: the mean over the fragments. Lengths are the axes of the solid ellipsoid with the fragment''s moments of inertia. Off without such a fragment.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'fragments_c_over_a', '1', 'Shortest over longest length of the same fragments.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'fragments_shaped', '1', 'Number of fragments of at least 60 particles, without the largest: those whose shapes count.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'frequency', '1/s', 'Vibration: frequency of the first mode, from its zero crossings.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'largest_axis_middle', '1', 'Middle over longest axis of the ellipsoid that has the moments of inertia of the largest fragment. Off when that has fewer than 100 particles.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'largest_axis_short', '1', 'Shortest over longest axis of the same ellipsoid. 1 is a sphere.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'largest_bare_fraction', '1', 'M_1/M of the core: mass of the largest fragment without its damaged layer over the target''s mass, with the static strength.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'largest_dynamic_fraction', '1', 'M_1/M with the damaged layer and without the static strength.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'largest_speed', 'm/s', 'Speed of the largest fragment''s centre of mass. Off when that has fewer than 100 particles.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'largest_veneer_fraction', '1', 'M_1/M: mass of the largest fragment with its damaged layer (veneer) over the target''s mass, with the static strength.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'limited_courant', '1', 'Share of the steps limited by the speed of sound and viscosity, or by a damped side.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'limited_damage', '1', 'Share of the steps limited by the growth of damage.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'limited_density', '1', 'Share of the steps limited by the change of density.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'limited_distention', '1', 'Share of the steps limited by the closing of pores.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'limited_energy', '1', 'Share of the steps limited by the change of internal energy.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'limited_force', '1', 'Share of the steps limited by the acceleration.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'mean_damage', '1', 'Mean damage D of the target at the end, weighted by mass.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'mean_distention', '1', 'Mean distention of the target at the end, weighted by mass, at zero pressure. 1 is solid; off without pores.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'neighbours', '1', 'Mean number of neighbours within 2h at the end.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'particles', '1', 'Number of particles in the target (in both bodies of a collision).', 1);

INSERT INTO column_doc VALUES ('result_sph', 'peak_strain', '1', 'Stretch: strain (strain rate times time) at the largest stress.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'peak_stress', 'Pa', 'Stretch: largest mean axial stress between the grips.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'peak_time', 's', 'Stretch: time of the largest stress.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'precursor_distention', '1', 'Piston: mean distention between precursor and shock.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'precursor_distention_exact', '1', 'Piston: distention behind the precursor on the elastic branch.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'precursor_pressure', 'Pa', 'Piston: mean pressure between precursor and shock.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'precursor_pressure_exact', 'Pa', 'Piston: exact pressure behind the precursor: that at which pores begin to close, or less when the piston is slow.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'precursor_speed', 'm/s', 'Piston: speed of the elastic precursor, which runs ahead of the crushing front; off where there is none, and when the shock is faster. Of no use, and maybe below 0, with the warning arrival.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'precursor_speed_exact', 'm/s', 'Piston: speed of the precursor by the jump conditions.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'projectile_mass', 'kg', 'Mass of the projectile; off without one.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'projectile_particles', '1', 'Number of particles in the projectile or piston.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'rebound', '1', 'Collision: speed of separation of the bodies over their speed of approach.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'run_id', NULL, 'the run', 0);

INSERT INTO column_doc VALUES ('result_sph', 'second_angle', 'rad', 'Impact: angle between the directions from the centre of mass to the point of impact and to the second largest fragment. 180 deg is the antipode. Off when that has fewer than 100 particles.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'second_mass', 'kg', 'Mass of the second largest fragment; off when there is only one.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'shock_density', 'kg/m^3', 'Piston: mean density behind the shock, in the middle half between piston and shock.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'shock_density_exact', 'kg/m^3', 'Piston: density behind the shock by the jump conditions.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'shock_distention', '1', 'Piston: mean distention behind the shock, in the same region; off without pores.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'shock_distention_exact', '1', 'Piston: distention behind the shock by the jump conditions and the crush curve.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'shock_pressure', 'Pa', 'Piston: mean pressure behind the shock, in the same region.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'shock_pressure_exact', 'Pa', 'Piston: pressure behind the shock by the jump conditions.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'shock_speed', 'm/s', 'Piston: speed of the shock (behind a precursor: of the crushing front) over the second half of the run. The front is where density passes the mean of the values ahead and behind. Off when the piston is too slow for a shock. Of no use, and maybe below 0, with the warning arrival.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'shock_speed_exact', 'm/s', 'Piston: speed of the shock by the jump conditions.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'specific_energy', 'J/kg', 'Q: kinetic energy of the projectile over the mass of the target; off without a projectile.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'stop_reason', NULL, 'Why the run ended. One of: running, quiet, end-time, fault', 1);

INSERT INTO column_doc VALUES ('result_sph', 'target_mass', 'kg', 'Mass of the target, in a collision of both bodies. All mass fractions are shares of it, so they leave the projectile out.', 1);

INSERT INTO column_doc VALUES ('result_sph', 'undamaged_fraction', '1', 'Mass share of the target''s particles with damage below fragments.damage. Particles that only the static strength breaks count as undamaged.', 1);

INSERT INTO column_doc VALUES ('run', 'attempt', NULL, 'which attempt succeeded, from 1', 0);

INSERT INTO column_doc VALUES ('run', 'complete_mass', 'kg', 'The spectrum of fragments is complete from this mass on: 10 particles (sph: 9.5 of the heaviest) or 2 grains (dem: 1.5 mean ones). Exponents use heavier fragments only.', 1);

INSERT INTO column_doc VALUES ('run', 'counts', NULL, '1: part of the statistics (not surplus or excluded, completed or ended at its time, the main results are numbers)', 0);

INSERT INTO column_doc VALUES ('run', 'cpu_time', 's', 'processor time of the successful attempt', 0);

INSERT INTO column_doc VALUES ('run', 'digest', NULL, 'changes when any bit changes of what the run determined: results, masses, estimates, seed, identity', 0);

INSERT INTO column_doc VALUES ('run', 'dust_fraction', '1', 'Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 1);

INSERT INTO column_doc VALUES ('run', 'energy_error', '1', 'Energy gained or lost by numerical errors, as a share of the energy put in; in sph without the energy of the motion of all matter together, which no collision can use.', 1);

INSERT INTO column_doc VALUES ('run', 'excluded', NULL, 'why a person excluded the run (clast exclude); NULL: it is not excluded', 0);

INSERT INTO column_doc VALUES ('run', 'excluded_at', NULL, 'when, UTC, ISO 8601', 0);

INSERT INTO column_doc VALUES ('run', 'fields_digest', NULL, 'changes when any bit of that file changes; NULL in older rows', 0);

INSERT INTO column_doc VALUES ('run', 'fields_path', NULL, 'HDF5 file with its fields, relative to the store''s folder; NULL when none was kept', 0);

INSERT INTO column_doc VALUES ('run', 'finished_at', 's', 'when it was stored, seconds since 1970-01-01 UTC', 0);

INSERT INTO column_doc VALUES ('run', 'fragment_count', '1', 'Fragments of any size, single grains (dust) included.', 1);

INSERT INTO column_doc VALUES ('run', 'host', NULL, 'machine that computed it', 0);

INSERT INTO column_doc VALUES ('run', 'identity', NULL, '128-bit hash of engine, results_version, active inputs and seed: the same run is never stored twice', 0);

INSERT INTO column_doc VALUES ('run', 'kinetic_energy_share', '1', 'Translation energy of the fragments over the energy put in.', 1);

INSERT INTO column_doc VALUES ('run', 'largest_fraction', '1', 'Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 1);

INSERT INTO column_doc VALUES ('run', 'mean_fragment_mass', 'kg', 'Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 1);

INSERT INTO column_doc VALUES ('run', 'mean_fragment_mass_rest', 'kg', 'The same without the largest fragment.', 1);

INSERT INTO column_doc VALUES ('run', 'message', NULL, 'What went wrong, in words; empty when nothing did.', 1);

INSERT INTO column_doc VALUES ('run', 'momentum_error', '1', 'Change of total momentum minus the impulse of external forces, as a share of the sum of the momenta of all grains or particles.', 1);

INSERT INTO column_doc VALUES ('run', 'peak_memory', 'B', 'largest resident memory of the successful attempt', 0);

INSERT INTO column_doc VALUES ('run', 'point_id', NULL, 'the point it belongs to', 0);

INSERT INTO column_doc VALUES ('run', 'rank', NULL, 'MPI rank that computed it', 0);

INSERT INTO column_doc VALUES ('run', 'replicate', NULL, 'which seed of the point, from 0', 0);

INSERT INTO column_doc VALUES ('run', 'results_version', NULL, 'version of the engine''s results; statistics never mix two', 0);

INSERT INTO column_doc VALUES ('run', 'run_id', NULL, 'number of the run in this store', 0);

INSERT INTO column_doc VALUES ('run', 'second_fraction', '1', 'Mass of the second largest fragment over the total mass, M_2/M.', 1);

INSERT INTO column_doc VALUES ('run', 'seed', NULL, 'the seed (64 bits, shown as a signed number)', 0);

INSERT INTO column_doc VALUES ('run', 'session_id', NULL, 'the session that computed it', 0);

INSERT INTO column_doc VALUES ('run', 'single_count', '1', 'Fragments of one grain or particle: below the model''s resolution.', 1);

INSERT INTO column_doc VALUES ('run', 'state', NULL, 'How the run ended: with a usable result (completed, end-time), or without one. One of: completed, end-time, not-finite, time-step, energy, invalid', 1);

INSERT INTO column_doc VALUES ('run', 'steps', '1', 'Time steps taken.', 1);

INSERT INTO column_doc VALUES ('run', 'surplus', NULL, 'above 0: left out of statistics. 1: beyond the prefix a stopping rule decided on; 2: excluded; 3: both', 0);

INSERT INTO column_doc VALUES ('run', 'time', 's', 'Simulated time at the end.', 1);

INSERT INTO column_doc VALUES ('run', 'time_step', 's', 'The smallest time step used.', 1);

INSERT INTO column_doc VALUES ('run', 'total_mass', 'kg', 'Mass of the body at the end (two dimensions: per metre of thickness).', 1);

INSERT INTO column_doc VALUES ('run', 'wall_time', 's', 'elapsed time of the successful attempt', 0);

INSERT INTO column_doc VALUES ('run', 'warnings', NULL, 'Conditions that a usable run does not meet, a word for each; empty when it meets all.', 1);

INSERT INTO column_doc VALUES ('runs', 'attempt', NULL, 'which attempt succeeded, from 1', 0);

INSERT INTO column_doc VALUES ('runs', 'beams', '1', 'Number of beams at the start, without those of the explosive grain.', 0);

INSERT INTO column_doc VALUES ('runs', 'broken', '1', 'Beams broken.', 0);

INSERT INTO column_doc VALUES ('runs', 'broken_bend', '1', 'Broken beams for which the bending term was the larger one.', 0);

INSERT INTO column_doc VALUES ('runs', 'broken_share', '1', 'Broken beams over all beams.', 0);

INSERT INTO column_doc VALUES ('runs', 'broken_stretch', '1', 'Broken beams for which the stretching term of the breaking rule was the larger one.', 0);

INSERT INTO column_doc VALUES ('runs', 'cease_time', 's', 'Time when fracture ceased: damage has grown by less than stop.quiet_growth since. Off when fracture has not ceased.', 0);

INSERT INTO column_doc VALUES ('runs', 'clamped_share', '1', 'energy.clamped over the energy put in, without that of the motion of all matter together. energy_error does not subtract it.', 0);

INSERT INTO column_doc VALUES ('runs', 'compaction_depth', 'm', 'Impact: depth at the start of the deepest compacted particle near the axis; off without pores.', 0);

INSERT INTO column_doc VALUES ('runs', 'compaction_mass_fraction', '1', 'Impact: mass share of the target that was compacted: its distention at zero pressure fell from 1.01 or more to below 1.01. Off without pores.', 0);

INSERT INTO column_doc VALUES ('runs', 'compaction_reach', 'm', 'Impact: largest distance from the point of impact at which matter lost a hundredth of its pores; off without pores.', 0);

INSERT INTO column_doc VALUES ('runs', 'compaction_volume', 'm^3', 'Impact: volume that the retained matter lost as its pores closed; off without pores.', 0);

INSERT INTO column_doc VALUES ('runs', 'complete_mass', 'kg', 'The spectrum of fragments is complete from this mass on: 10 particles (sph: 9.5 of the heaviest) or 2 grains (dem: 1.5 mean ones). Exponents use heavier fragments only.', 0);

INSERT INTO column_doc VALUES ('runs', 'counts', NULL, '1: part of the statistics (not surplus or excluded, completed or ended at its time, the main results are numbers)', 0);

INSERT INTO column_doc VALUES ('runs', 'cpu_time', 's', 'processor time of the successful attempt', 0);

INSERT INTO column_doc VALUES ('runs', 'cracks', '1', 'Stretch: number of parts of more than 1 % of the rod''s mass, minus one. Parts are found without static strength and without damaged layers. Overlapping cracks joined by broken rock do not count, even if the rod no longer carries load.', 0);

INSERT INTO column_doc VALUES ('runs', 'crater_compaction_share', '1', 'Impact: volume lost by compaction over the sum of that volume and the ejecta''s volume at the start. 1 is a crater made by compaction alone. Off when both volumes are 0.', 0);

INSERT INTO column_doc VALUES ('runs', 'crater_depth', 'm', 'Impact: largest depth of the crater below the surface at the start, along the outward normal at the point of impact. 0 when it is less than the spacing of the particles.', 0);

INSERT INTO column_doc VALUES ('runs', 'crater_radius', 'm', 'Impact: radius of a circle whose area is that of the crater at the surface.', 0);

INSERT INTO column_doc VALUES ('runs', 'crater_volume', 'm^3', 'Impact: volume of the crater, between the surface at the start and the surface of the retained matter.', 0);

INSERT INTO column_doc VALUES ('runs', 'density_held_share', '1', 'Share of all particle steps that held the density at its lower limit. Such a step adds no energy.', 0);

INSERT INTO column_doc VALUES ('runs', 'doubtful', '1', '1: the run breaks a condition, so that results are in doubt; clast explain WORD says what a word of warnings means', 0);

INSERT INTO column_doc VALUES ('runs', 'dust_fraction', '1', 'Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or single grains (dem).', 0);

INSERT INTO column_doc VALUES ('runs', 'ejecta_mass_fraction', '1', 'Impact: mass share of the target leaving faster than crater.ejection_speed and crater.escape_speed. Times target_mass: their mass. `clast spectrum STORE --ejecta` shows it over the speed.', 0);

INSERT INTO column_doc VALUES ('runs', 'ejecta_momentum', 'kg m/s', 'Impact: momentum of the ejecta along the outward normal.', 0);

INSERT INTO column_doc VALUES ('runs', 'ejecta_momentum_enhancement', '1', 'Impact: 1 plus the momentum of the ejecta, and of matter of the projectile that moves outwards, over that of the projectile, along the normal: what the rest of the target gains, over what the projectile brings. Ejecta are faster than crater.ejection_speed; all matter counts that is faster than crater.escape_speed.', 0);

INSERT INTO column_doc VALUES ('runs', 'end_triangle_share', '1', 'Compression: share of beams broken inside the two 45-degree triangles on the confined ends, over the same share outside them, up to the largest stress. 0 is intact triangles, 1 no pattern.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_beam', 'J/m', 'Energy stored in beams at the end.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_broken_beam', 'J/m', 'Energy of the beams when they broke: the energy of the new surfaces. With contact.bonded off, less what contacts store that begin with a break.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_clamped', 'J', 'Energy added where internal energy would have become negative.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_damped', 'J', 'Energy that the damping layer of a box took out of motion (sides.far: damped); 0 in all other scenes.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_damping', 'J/m', 'Energy taken by damping.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_error', '1', 'Energy gained or lost by numerical errors, as a share of the energy put in; in sph without the energy of the motion of all matter together, which no collision can use.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_external_work', 'J/m', 'Work done by moving boundaries.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_friction', 'J/m', 'Energy taken by friction.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_internal', 'J', 'Internal energy at the end, elastic energy included.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_vibration', 'J/m', 'Part of the kinetic energy that is motion inside fragments: neither their translation nor their rotation. Without damping it does not decay, and breaks more beams.', 0);

INSERT INTO column_doc VALUES ('runs', 'energy_work_of_held', 'J', 'Work done on the body by matter that is held at a given velocity: the grips of a stretch, the piston; 0 in all other scenes.', 0);

INSERT INTO column_doc VALUES ('runs', 'engine', NULL, 'name of the engine', 0);

INSERT INTO column_doc VALUES ('runs', 'excluded', NULL, 'why a person excluded the run (clast exclude); NULL: it is not excluded', 0);

INSERT INTO column_doc VALUES ('runs', 'excluded_at', NULL, 'when, UTC, ISO 8601', 0);

INSERT INTO column_doc VALUES ('runs', 'failure_strain', '1', 'Strain at the largest stress.', 0);

INSERT INTO column_doc VALUES ('runs', 'fields_path', NULL, 'HDF5 file with its fields, relative to the store''s folder; NULL when none was kept', 0);

INSERT INTO column_doc VALUES ('runs', 'final_strain', '1', 'Strain at the end of the loading.', 0);

INSERT INTO column_doc VALUES ('runs', 'finished_at', 's', 'when it was stored, seconds since 1970-01-01 UTC', 0);

INSERT INTO column_doc VALUES ('runs', 'first_break', 's', 'Time of the first break; off when none broke.', 0);

INSERT INTO column_doc VALUES ('runs', 'first_damage', 's', 'Time when damage of a body with flaws began; off without damage. It is looked for at every eighth step, so it may be eight steps late.', 0);

INSERT INTO column_doc VALUES ('runs', 'flaws', '1', 'Number of explicit flaws in all bodies.', 0);

INSERT INTO column_doc VALUES ('runs', 'fracture_ceased', NULL, 'Fracture ceased by the rule of stop.quiet_time, or no damage began before stop.end_time.', 0);

INSERT INTO column_doc VALUES ('runs', 'fragment_count', '1', 'Fragments of any size, single grains (dust) included.', 0);

INSERT INTO column_doc VALUES ('runs', 'fragments_b_over_a', '1', 'Middle over longest length of fragments of at least 60 particles, without the largest: the mean over the fragments. Lengths are the axes of the solid ellipsoid with the fragment''s moments of inertia. Off without such a fragment.', 0);

INSERT INTO column_doc VALUES ('runs', 'fragments_c_over_a', '1', 'Shortest over longest length of the same fragments.', 0);

INSERT INTO column_doc VALUES ('runs', 'fragments_shaped', '1', 'Number of fragments of at least 60 particles, without the largest: those whose shapes count.', 0);

INSERT INTO column_doc VALUES ('runs', 'frequency', '1/s', 'Vibration: frequency of the first mode, from its zero crossings.', 0);

INSERT INTO column_doc VALUES ('runs', 'grains', '1', 'Number of grains, without the explosive one.', 0);

INSERT INTO column_doc VALUES ('runs', 'host', NULL, 'machine that computed it', 0);

INSERT INTO column_doc VALUES ('runs', 'identity', NULL, '128-bit hash of engine, results_version, active inputs and seed: the same run is never stored twice', 0);

INSERT INTO column_doc VALUES ('runs', 'kinetic_energy_share', '1', 'Translation energy of the fragments over the energy put in.', 0);

INSERT INTO column_doc VALUES ('runs', 'largest_axis_middle', '1', 'Middle over longest axis of the ellipsoid that has the moments of inertia of the largest fragment. Off when that has fewer than 100 particles.', 0);

INSERT INTO column_doc VALUES ('runs', 'largest_axis_short', '1', 'Shortest over longest axis of the same ellipsoid. 1 is a sphere.', 0);

INSERT INTO column_doc VALUES ('runs', 'largest_bare_fraction', '1', 'M_1/M of the core: mass of the largest fragment without its damaged layer over the target''s mass, with the static strength.', 0);

INSERT INTO column_doc VALUES ('runs', 'largest_dynamic_fraction', '1', 'M_1/M with the damaged layer and without the static strength.', 0);

INSERT INTO column_doc VALUES ('runs', 'largest_fraction', '1', 'Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target without the projectile (sph).', 0);

INSERT INTO column_doc VALUES ('runs', 'largest_loss', '1', 'Loss of M_1/M of the largest fragment in the second half of the run''s time; 0 for a final run. Expect about as much in the next doubling of the time.', 0);

INSERT INTO column_doc VALUES ('runs', 'largest_speed', 'm/s', 'Speed of the largest fragment''s centre of mass. Off when that has fewer than 100 particles.', 0);

INSERT INTO column_doc VALUES ('runs', 'largest_veneer_fraction', '1', 'M_1/M: mass of the largest fragment with its damaged layer (veneer) over the target''s mass, with the static strength.', 0);

INSERT INTO column_doc VALUES ('runs', 'last_break', 's', 'Time of the last break; off when none broke.', 0);

INSERT INTO column_doc VALUES ('runs', 'late_breaks', '1', 'Beams broken in the second half of the run''s time.', 0);

INSERT INTO column_doc VALUES ('runs', 'limited_courant', '1', 'Share of the steps limited by the speed of sound and viscosity, or by a damped side.', 0);

INSERT INTO column_doc VALUES ('runs', 'limited_damage', '1', 'Share of the steps limited by the growth of damage.', 0);

INSERT INTO column_doc VALUES ('runs', 'limited_density', '1', 'Share of the steps limited by the change of density.', 0);

INSERT INTO column_doc VALUES ('runs', 'limited_distention', '1', 'Share of the steps limited by the closing of pores.', 0);

INSERT INTO column_doc VALUES ('runs', 'limited_energy', '1', 'Share of the steps limited by the change of internal energy.', 0);

INSERT INTO column_doc VALUES ('runs', 'limited_force', '1', 'Share of the steps limited by the acceleration.', 0);

INSERT INTO column_doc VALUES ('runs', 'mean_damage', '1', 'Mean damage D of the target at the end, weighted by mass.', 0);

INSERT INTO column_doc VALUES ('runs', 'mean_distention', '1', 'Mean distention of the target at the end, weighted by mass, at zero pressure. 1 is solid; off without pores.', 0);

INSERT INTO column_doc VALUES ('runs', 'mean_fragment_mass', 'kg', 'Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m.', 0);

INSERT INTO column_doc VALUES ('runs', 'mean_fragment_mass_rest', 'kg', 'The same without the largest fragment.', 0);

INSERT INTO column_doc VALUES ('runs', 'message', NULL, 'What went wrong, in words; empty when nothing did.', 0);

INSERT INTO column_doc VALUES ('runs', 'momentum_error', '1', 'Change of total momentum minus the impulse of external forces, as a share of the sum of the momenta of all grains or particles.', 0);

INSERT INTO column_doc VALUES ('runs', 'neighbours', '1', 'Mean number of neighbours within 2h at the end.', 0);

INSERT INTO column_doc VALUES ('runs', 'overlap_share', '1', 'Pairs of grains that overlap, at the end, over the pairs that were neighbours at the start. Above 1 if many grains overlap that were none.', 0);

INSERT INTO column_doc VALUES ('runs', 'particles', '1', 'Number of particles in the target (in both bodies of a collision).', 0);

INSERT INTO column_doc VALUES ('runs', 'passing_share', '1', 'Fastest approach of two near grains that no beam joins and whose paths meet, over the speed at which they pass through each other. Above 1 the model has no answer for them. Off without contacts.', 0);

INSERT INTO column_doc VALUES ('runs', 'peak_memory', 'B', 'largest resident memory of the successful attempt', 0);

INSERT INTO column_doc VALUES ('runs', 'peak_strain', '1', 'Stretch: strain (strain rate times time) at the largest stress.', 0);

INSERT INTO column_doc VALUES ('runs', 'peak_stress', 'Pa', 'Stretch: largest mean axial stress between the grips.', 0);

INSERT INTO column_doc VALUES ('runs', 'peak_time', 's', 'Stretch: time of the largest stress.', 0);

INSERT INTO column_doc VALUES ('runs', 'point_id', NULL, 'number of the point: one set of input values', 0);

INSERT INTO column_doc VALUES ('runs', 'poisson_ratio', '1', 'nu: minus the slope of lateral against axial strain.', 0);

INSERT INTO column_doc VALUES ('runs', 'precursor_distention', '1', 'Piston: mean distention between precursor and shock.', 0);

INSERT INTO column_doc VALUES ('runs', 'precursor_distention_exact', '1', 'Piston: distention behind the precursor on the elastic branch.', 0);

INSERT INTO column_doc VALUES ('runs', 'precursor_pressure', 'Pa', 'Piston: mean pressure between precursor and shock.', 0);

INSERT INTO column_doc VALUES ('runs', 'precursor_pressure_exact', 'Pa', 'Piston: exact pressure behind the precursor: that at which pores begin to close, or less when the piston is slow.', 0);

INSERT INTO column_doc VALUES ('runs', 'precursor_speed', 'm/s', 'Piston: speed of the elastic precursor, which runs ahead of the crushing front; off where there is none, and when the shock is faster. Of no use, and maybe below 0, with the warning arrival.', 0);

INSERT INTO column_doc VALUES ('runs', 'precursor_speed_exact', 'm/s', 'Piston: speed of the precursor by the jump conditions.', 0);

INSERT INTO column_doc VALUES ('runs', 'projectile_mass', 'kg', 'Mass of the projectile; off without one.', 0);

INSERT INTO column_doc VALUES ('runs', 'projectile_particles', '1', 'Number of particles in the projectile or piston.', 0);

INSERT INTO column_doc VALUES ('runs', 'rank', NULL, 'MPI rank that computed it', 0);

INSERT INTO column_doc VALUES ('runs', 'rebound', '1', 'Collision: speed of separation of the bodies over their speed of approach.', 0);

INSERT INTO column_doc VALUES ('runs', 'replicate', NULL, 'which seed of the point, from 0', 0);

INSERT INTO column_doc VALUES ('runs', 'result_dem_angular_momentum_error', '1', 'Change of the angular momentum about the origin, over the larger of its value at the start and the sum of the momenta times half of the body''s size. Off for bodies between moving sides.', 0);

INSERT INTO column_doc VALUES ('runs', 'result_dem_energy_contact', 'J/m', 'Energy stored in contacts at the end (printed law: work done on contacts, of which only a part can return).', 0);

INSERT INTO column_doc VALUES ('runs', 'result_dem_energy_input', 'J/m', 'Energy put in: initial kinetic energy (collision: in the common frame), or the work of the load.', 0);

INSERT INTO column_doc VALUES ('runs', 'result_dem_energy_kinetic', 'J/m', 'Kinetic energy at the end.', 0);

INSERT INTO column_doc VALUES ('runs', 'result_dem_stop_reason', NULL, 'Why the run ended. One of: running, quiet, end-time, strain, failure, fault', 0);

INSERT INTO column_doc VALUES ('runs', 'result_sph_angular_momentum_error', '1', 'Relative change of angular momentum; off with grips, a piston or a damping layer. The scale is the larger of the angular momentum at the start and the sum of momenta (the larger of start and end) times the target''s extent. Only axes count across which nothing is periodic.', 0);

INSERT INTO column_doc VALUES ('runs', 'result_sph_energy_contact', 'J', 'Energy of the overlap of bodies in contact at the end. Off with method.contact: welded.', 0);

INSERT INTO column_doc VALUES ('runs', 'result_sph_energy_input', 'J', 'Energy put in: kinetic energy at the start plus the absolute value of energy.work_of_held.', 0);

INSERT INTO column_doc VALUES ('runs', 'result_sph_energy_kinetic', 'J', 'Kinetic energy at the end.', 0);

INSERT INTO column_doc VALUES ('runs', 'result_sph_stop_reason', NULL, 'Why the run ended. One of: running, quiet, end-time, fault', 0);

INSERT INTO column_doc VALUES ('runs', 'results_version', NULL, 'version of the engine''s results; statistics never mix two', 0);

INSERT INTO column_doc VALUES ('runs', 'run_id', NULL, 'number of the run in this store', 0);

INSERT INTO column_doc VALUES ('runs', 'scene', NULL, 'name of the scene the inputs started from', 0);

INSERT INTO column_doc VALUES ('runs', 'second_angle', 'rad', 'Impact: angle between the directions from the centre of mass to the point of impact and to the second largest fragment. 180 deg is the antipode. Off when that has fewer than 100 particles.', 0);

INSERT INTO column_doc VALUES ('runs', 'second_fraction', '1', 'Mass of the second largest fragment over the total mass, M_2/M.', 0);

INSERT INTO column_doc VALUES ('runs', 'second_mass', 'kg', 'Mass of the second largest fragment; off when there is only one.', 0);

INSERT INTO column_doc VALUES ('runs', 'seed', NULL, 'the seed (64 bits, shown as a signed number)', 0);

INSERT INTO column_doc VALUES ('runs', 'session_id', NULL, 'the session that computed it', 0);

INSERT INTO column_doc VALUES ('runs', 'shock_density', 'kg/m^3', 'Piston: mean density behind the shock, in the middle half between piston and shock.', 0);

INSERT INTO column_doc VALUES ('runs', 'shock_density_exact', 'kg/m^3', 'Piston: density behind the shock by the jump conditions.', 0);

INSERT INTO column_doc VALUES ('runs', 'shock_distention', '1', 'Piston: mean distention behind the shock, in the same region; off without pores.', 0);

INSERT INTO column_doc VALUES ('runs', 'shock_distention_exact', '1', 'Piston: distention behind the shock by the jump conditions and the crush curve.', 0);

INSERT INTO column_doc VALUES ('runs', 'shock_pressure', 'Pa', 'Piston: mean pressure behind the shock, in the same region.', 0);

INSERT INTO column_doc VALUES ('runs', 'shock_pressure_exact', 'Pa', 'Piston: pressure behind the shock by the jump conditions.', 0);

INSERT INTO column_doc VALUES ('runs', 'shock_speed', 'm/s', 'Piston: speed of the shock (behind a precursor: of the crushing front) over the second half of the run. The front is where density passes the mean of the values ahead and behind. Off when the piston is too slow for a shock. Of no use, and maybe below 0, with the warning arrival.', 0);

INSERT INTO column_doc VALUES ('runs', 'shock_speed_exact', 'm/s', 'Piston: speed of the shock by the jump conditions.', 0);

INSERT INTO column_doc VALUES ('runs', 'single_count', '1', 'Fragments of one grain or particle: below the model''s resolution.', 0);

INSERT INTO column_doc VALUES ('runs', 'sound_speed_compression', 'm/s', 'Estimate sqrt((E + Y sqrt(pi)/2)/rho): beams and contacts, aligned with the wave.', 0);

INSERT INTO column_doc VALUES ('runs', 'sound_speed_extension', 'm/s', 'Estimate sqrt(E/rho): beams alone, aligned with the wave (the square lattice''s value).', 0);

INSERT INTO column_doc VALUES ('runs', 'specific_energy', 'J/kg', 'Q: kinetic energy of the projectile over the mass of the target; off without a projectile.', 0);

INSERT INTO column_doc VALUES ('runs', 'stable_time_step', 's', 'Longest stable time step of the body as it starts: 2/omega_max for `verlet`, 0.54/omega_max for `gear`.', 0);

INSERT INTO column_doc VALUES ('runs', 'state', NULL, 'How the run ended: with a usable result (completed, end-time), or without one. One of: completed, end-time, not-finite, time-step, energy, invalid', 0);

INSERT INTO column_doc VALUES ('runs', 'steps', '1', 'Time steps taken.', 0);

INSERT INTO column_doc VALUES ('runs', 'strength', 'Pa', 'Largest stress under load, at any time step.', 0);

INSERT INTO column_doc VALUES ('runs', 'study', NULL, '1: only studies and searches (clast converge, find, ...) asked for the point; 0 also in a store without other campaigns', 0);

INSERT INTO column_doc VALUES ('runs', 'surplus', NULL, 'above 0: left out of statistics. 1: beyond the prefix a stopping rule decided on; 2: excluded; 3: both', 0);

INSERT INTO column_doc VALUES ('runs', 'target_mass', 'kg', 'Mass of the target, in a collision of both bodies. All mass fractions are shares of it, so they leave the projectile out.', 0);

INSERT INTO column_doc VALUES ('runs', 'threshold_energy', 'J/m', 'Energy that would bring every beam, unbent, to its own threshold. Off without breaking.', 0);

INSERT INTO column_doc VALUES ('runs', 'time', 's', 'Simulated time at the end.', 0);

INSERT INTO column_doc VALUES ('runs', 'time_step', 's', 'The smallest time step used.', 0);

INSERT INTO column_doc VALUES ('runs', 'total_mass', 'kg', 'Mass of the body at the end (two dimensions: per metre of thickness).', 0);

INSERT INTO column_doc VALUES ('runs', 'undamaged_fraction', '1', 'Mass share of the target''s particles with damage below fragments.damage. Particles that only the static strength breaks count as undamaged.', 0);

INSERT INTO column_doc VALUES ('runs', 'upright_share', '1', 'Compression: broken beams whose crack (the common side) lies within 30 degrees of the load''s direction, over all broken beams, up to the largest stress. Of isotropic sides it would be 1/3.', 0);

INSERT INTO column_doc VALUES ('runs', 'wall_time', 's', 'elapsed time of the successful attempt', 0);

INSERT INTO column_doc VALUES ('runs', 'warnings', NULL, 'Conditions that a usable run does not meet, a word for each; empty when it meets all.', 0);

INSERT INTO column_doc VALUES ('runs', 'young_modulus', 'Pa', 'K: slope of stress against strain under uniaxial load, up to the first break.', 0);

INSERT INTO column_doc VALUES ('session', 'campaign_id', NULL, 'the campaign it computed; NULL in sessions of older programs that computed nothing', 0);

INSERT INTO column_doc VALUES ('session', 'ended_at', NULL, 'UTC, ISO 8601; NULL while running or when it was killed', 0);

INSERT INTO column_doc VALUES ('session', 'facts', NULL, 'provenance, JSON: version, commit, compiler, flags, processor class, libraries, ranks, slots, command line', 0);

INSERT INTO column_doc VALUES ('session', 'host', NULL, 'machine of the manager', 0);

INSERT INTO column_doc VALUES ('session', 'outcome', NULL, 'how it ended: a status name; NULL while running or when it was killed', 0);

INSERT INTO column_doc VALUES ('session', 'pid', NULL, 'process of the manager', 0);

INSERT INTO column_doc VALUES ('session', 'session_id', NULL, 'number of the invocation that computed', 0);

INSERT INTO column_doc VALUES ('session', 'started_at', NULL, 'UTC, ISO 8601, to the millisecond', 0);

INSERT INTO column_doc VALUES ('shape_file', 'bytes', NULL, 'the file as it was read, STL or OBJ', 0);

INSERT INTO column_doc VALUES ('shape_file', 'hash', NULL, 'SHA-256 of the file, the value of inputs that name one (target.mesh.file)', 0);

INSERT INTO column_doc VALUES ('spectra', 'bin', NULL, 'number of a mass bin: ten per decade, bin 0 starts at 1 kg', 0);

INSERT INTO column_doc VALUES ('spectra', 'count', '1', 'fragments in the bin, of all runs', 0);

INSERT INTO column_doc VALUES ('spectra', 'count_hw95', '1', 'half width of the 95 % confidence interval of count_mean (Student); NULL: one run, or all are equal to 14 digits', 0);

INSERT INTO column_doc VALUES ('spectra', 'count_mean', '1', 'fragments in the bin per run', 0);

INSERT INTO column_doc VALUES ('spectra', 'count_sd', '1', 'standard deviation of the count between runs', 0);

INSERT INTO column_doc VALUES ('spectra', 'density', '1/kg', 'fragment number density F(m): share of all fragments per unit mass; its integral over mass is 1', 0);

INSERT INTO column_doc VALUES ('spectra', 'engine', NULL, 'name of the engine', 0);

INSERT INTO column_doc VALUES ('spectra', 'lower', 'kg', 'lower edge, inside the bin', 0);

INSERT INTO column_doc VALUES ('spectra', 'mass', 'kg', 'their mass', 0);

INSERT INTO column_doc VALUES ('spectra', 'n', '1', 'runs of the point that count', 0);

INSERT INTO column_doc VALUES ('spectra', 'point_id', NULL, 'the point', 0);

INSERT INTO column_doc VALUES ('spectra', 'results_version', NULL, 'version of the engine''s results', 0);

INSERT INTO column_doc VALUES ('spectra', 'runs', '1', 'runs that count and have a fragment in the bin', 0);

INSERT INTO column_doc VALUES ('spectra', 'scene', NULL, 'name of the scene the inputs started from', 0);

INSERT INTO column_doc VALUES ('spectra', 'study', NULL, '1: only studies and searches (clast converge, find, ...) asked for the point; 0 also in a store without other campaigns', 0);

INSERT INTO column_doc VALUES ('spectra', 'upper', 'kg', 'upper edge, outside the bin', 0);

INSERT INTO column_doc VALUES ('spectrum', 'bin', NULL, 'mass bin (table bin); only bins that hold something', 0);

INSERT INTO column_doc VALUES ('spectrum', 'count', '1', 'fragments in the bin', 0);

INSERT INTO column_doc VALUES ('spectrum', 'mass', 'kg', 'their mass', 0);

INSERT INTO column_doc VALUES ('spectrum', 'run_id', NULL, 'the run', 0);

INSERT INTO column_doc VALUES ('table_digest', 'digest', NULL, 'changes when any bit of any of its rows changes', 0);

INSERT INTO column_doc VALUES ('table_digest', 'row_count', NULL, 'its rows, counted in the transaction that changed them', 0);

INSERT INTO column_doc VALUES ('table_digest', 'table_name', NULL, 'a table whose rows no other digest protects from loss', 0);
