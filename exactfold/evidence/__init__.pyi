from exactfold.evidence.check import check_compact as check_compact
from exactfold.evidence.entries import write_certificate as write_certificate
from exactfold.evidence.listing import certificate as certificate
from exactfold.evidence.motion import motion_certificate as motion_certificate
from exactfold.evidence.pieces import pieces_certificate as pieces_certificate
from exactfold.evidence.read import read_branches as read_branches
from exactfold.evidence.single import branch_certificate as branch_certificate
