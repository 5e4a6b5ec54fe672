% A cost of exploration for saras.model.TrajectoryOptimizer, computed by Octave: TrajectoryOptimizer(..., cost="exploration_cost.m").
%
% estimates: struct of what is known at each point, (c, n) each, vectors (c, n, 3): c paths of n points. Fields: those of
% saras.model.SurfaceEstimates, and known. NaN with an infinite deviation: not known there.
% points: (c, n, 3) [m], base frame. costs: (c, 1), one a path; the least is best.
%
% This one looks for the stiff lump and charges for the way: 100 N/m a centimetre.
function costs = exploration_cost (estimates, points)
  known = estimates.known;
  middle = 0;
  if (any (known(:)))
    middle = median (estimates.stiffness_N_m(known));
  end
  stiffness = estimates.stiffness_N_m;
  stiffness(! known) = middle;
  std = min (estimates.stiffness_std_N_m, 500);
  way_m = sum (sqrt (sum (diff (points, 1, 2) .^ 2, 3)), 2);
  costs = -max (stiffness + 2 * std, [], 2) + 1e4 * way_m;
end
