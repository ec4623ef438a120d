from exactfold.certify.ball_krawczyk import arb_krawczyk as arb_krawczyk
from exactfold.certify.ball_newton import interval_newton as interval_newton
from exactfold.certify.box import IsolatingBox as IsolatingBox
from exactfold.certify.box import Uncertified as Uncertified
from exactfold.certify.exact_krawczyk import krawczyk as krawczyk
from exactfold.certify.isolation import Isolation as Isolation
from exactfold.certify.isolation import isolate as isolate
